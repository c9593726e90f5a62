#!/usr/bin/env bash
# Runs the viewer's tests on a display without a screen. Exit code 77 (skipped) where there is none.
set -euo pipefail
command -v xvfb-run >/dev/null && command -v xauth >/dev/null || { echo "skipped: no Xvfb (Debian: apt-get install xvfb xauth)"; exit 77; }
exec xvfb-run -a -s "-screen 0 1280x1024x24" "$@" --gtest_brief=1
