#!/usr/bin/env bash
# doxygen.sh BUILD: the pages of the installed headers are made, without a warning. 77: there is no doxygen.
set -euo pipefail
command -v doxygen >/dev/null || { echo "skipped: no doxygen (Debian: apt-get install doxygen)"; exit 77; }
doxygen "$1/Doxyfile"
ls "$1/doxygen/html/index.html"
