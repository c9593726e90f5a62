#!/usr/bin/env bash
# Entry point of weir: ./weir.sh COMMAND [...]
#   build               everything, with tests and benchmarks
#   run SCENE [...]     simulate a scene, or a case by its name
#   view RESULT         the frames of a run in a window
#   live SCENE          a scene in a window, with interactive forcing
#   picture RESULT      the frames of a run as a PNG
#   movie RESULT        the frames of a run as a movie; a scene or a case is run first
#   validate [...]      the claims of the cases
#   cost [...]          error against computing time; --plan SCENE: estimate of a scene's cost
#   plan SCENE [...]    value, error and computing time of a quantity: --of QUANTITY --error 5% --budget 4ms
#   stability [...]     stability limits of solvers
#   report              the page of published results
#   list WHAT           solvers, effects, fields, studies, cases or devices
#   describe [WHAT]     what a scene may contain
#   test [...]          all tests; further arguments go to ctest
#   lint [WHAT]         warnings of clang 14 over the whole tree, or tidy: the checks of .clang-tidy
#   fuzz [SECONDS KIND] fuzzing of the readers of users' files
#   python              the package of Python, in build/release/python
#   docs                the book as a site, in build/docs/site
#   install DIR         the program, its cases and the library
#   package             the Debian packages, for any processor of this kind, in build/package/packages
# `./weir.sh COMMAND --help` prints the options. Each call installs the missing packages of that command (Debian 12, Ubuntu 24.04), configures, builds and runs it; a
# second call repeats only what changed. The executable is build/release/weir.
set -euo pipefail
here="$(cd "$(dirname "$0")" && pwd)"

weir_needs=(g++ cmake ninja-build git libeigen3-dev libfmt-dev libtomlplusplus-dev libcli11-dev nlohmann-json3-dev opencl-headers
            ocl-icd-opencl-dev libgsl-dev libmuparser-dev libfftw3-dev libsuitesparse-dev libopenblas-dev libvtk9-dev libembree-dev)
figures_need=(gnuplot-nox)
python_needs=(python3-dev pybind11-dev python3-numpy)
lint_needs=(clang-14 clang-tidy-14 libomp-14-dev)
fuzz_needs=(clang-14 libclang-rt-14-dev libomp-14-dev)
docs_need=(mkdocs libjs-katex)
package_needs=(dpkg-dev gzip lintian)
films_need=(ffmpeg)
tests_need=(ccache ffmpeg libgtest-dev libbenchmark-dev libhypre-dev libpetsc-real-dev libopenmpi-dev openmpi-bin libmpich-dev mpich pkgconf libnanoflann-dev pocl-opencl-icd oclgrind valgrind xvfb xauth chromium
            python3-pip python3-setuptools python3-pytest python3-matplotlib jupyter-nbconvert python3-ipykernel doxygen dpkg-dev)

install_missing() { # PACKAGE...
    if ! command -v dpkg-query >/dev/null; then
        echo "no apt here: these packages of Debian 12, or their likes, are assumed to be installed: $*" >&2
        return
    fi
    local installed missing=()
    installed="$(dpkg-query -W -f='${Package} ${Status}\n' "$@" 2>/dev/null | sed -n 's/ install ok installed$//p' || true)"
    for p in "$@"; do
        grep -qx -- "$p" <<<"$installed" || missing+=("$p")
    done
    [ ${#missing[@]} -eq 0 ] && return
    local sudo=()
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null || { echo "missing: ${missing[*]}; install them as root, or install sudo" >&2; exit 2; }
        sudo=(sudo)
    fi
    echo "installing: ${missing[*]}" >&2
    "${sudo[@]}" apt-get update -qq >&2
    "${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
}

# configure OPTION...: with them on; what nobody has asked for yet, tests and benchmarks, is off
configure() {
    local option wanted=()
    for option in "$@"; do
        grep -qs "^$option:BOOL=ON" "$here/build/release/CMakeCache.txt" || wanted+=("-D$option=ON")
    done
    [ -f "$here/build/release/build.ninja" ] || wanted=(-DWEIR_TESTS=OFF -DWEIR_BENCHMARKS=OFF "${wanted[@]}")
    [ ${#wanted[@]} -eq 0 ] || (cd "$here" && cmake --preset release "${wanted[@]}")
}

# build TARGET...
build() {
    configure
    cmake --build "$here/build/release" --target "$@"
}

# build_python: the module, and how to use it
build_python() {
    install_missing "${weir_needs[@]}" "${python_needs[@]}"
    configure WEIR_PYTHON
    build weir_python
    echo "use it: PYTHONPATH=$here/build/release/python /usr/bin/python3"
}

# build_packages: for any processor, so in a build of its own; lintian has the last word, but for the address:
# -DWEIR_MAINTAINER="NAME <ADDRESS>" gives one
build_packages() {
    install_missing "${weir_needs[@]}" "${python_needs[@]}" "${package_needs[@]}"
    local build="$here/build/package"
    (cd "$here" && cmake -G Ninja -S . -B "$build" -DCMAKE_BUILD_TYPE=Release -DCMAKE_INSTALL_PREFIX=/usr -DWEIR_NATIVE=OFF -DWEIR_PETSC=OFF -DWEIR_MPI=OFF -DWEIR_TESTS=OFF -DWEIR_BENCHMARKS=OFF -DWEIR_PYTHON=ON)
    cmake --build "$build"
    rm -rf "$build/packages"
    (cd "$build" && cpack -G DEB)
    lintian --fail-on error --allow-root --suppress-tags bogus-mail-host,bogus-mail-host-in-debian-changelog "$build"/packages/*.deb
    ls "$build"/packages/*.deb
}

# build_all: the tests and benchmarks too
build_all() {
    install_missing "${weir_needs[@]}" "${figures_need[@]}" "${python_needs[@]}" "${docs_need[@]}" "${tests_need[@]}"
    configure WEIR_TESTS WEIR_BENCHMARKS WEIR_PYTHON
    cmake --build "$here/build/release"
}

# run_tests [CTEST ARGUMENT...]: ctest; before its last line, how many tests were skipped and why. A skip that the machine does not explain
# is a failure.
run_tests() {
    local code=0 log
    log="$(mktemp)"
    # What weir itself would set: it starts itself again where these are missing, which doubles the time to start. package.fresh_root is without.
    export GOMP_SPINCOUNT="${GOMP_SPINCOUNT:-1000}" OPENBLAS_NUM_THREADS="${OPENBLAS_NUM_THREADS:-1}"
    ctest -j 2 --output-on-failure --output-junit "$here/build/release/tests.xml" "$@" | tee "$log" || code=$?
    "$here/tests/skipped.sh" "$here/build/release/tests.xml" "$here/build/release/weir" || code=$((code > 0 ? code : 1))
    grep '% tests passed' "$log" || true
    rm -f "$log"
    return "$code"
}

usage() {
    sed -n '2,/^set -/{/^# /{s/^# //;s/ Each call.*//;/^second call/d;p}}' "$0"
}

case "${1:-}" in
    build) build_all ;;
    run | picture | list | describe)
        install_missing "${weir_needs[@]}" && build weir >&2 && exec "$here/build/release/weir" "$@" ;;
    validate | cost | plan | stability | report)
        install_missing "${weir_needs[@]}" "${figures_need[@]}" && build weir >&2 && exec "$here/build/release/weir" "$@" ;;
    movie)
        install_missing "${weir_needs[@]}" "${films_need[@]}" && build weir >&2 && exec "$here/build/release/weir" "$@" ;;
    view | live) install_missing "${weir_needs[@]}" && build weir weir-view weir-live >&2 && exec "$here/build/release/weir" "$@" ;;
    lint) install_missing "${weir_needs[@]}" "${python_needs[@]}" "${tests_need[@]}" "${lint_needs[@]}" && exec "$here/tests/lint/clang.py" "${2:-warnings}" "${@:3}" ;;
    fuzz) install_missing "${weir_needs[@]}" "${fuzz_needs[@]}" && exec "$here/tests/fuzz/run.sh" "${@:2}" ;;
    python) build_python ;;
    docs) install_missing "${docs_need[@]}" && python3 "$here/docs/site/make.py" "$here/build/docs" ;;
    package) build_packages ;;
    test) build_all && cd "$here/build/release" && run_tests "${@:2}" ;;
    install) [ $# -eq 2 ] || { usage >&2; exit 2; }; install_missing "${weir_needs[@]}" && build weir weir-view weir-live >&2 && exec cmake --install "$here/build/release" --prefix "$2" ;;
    help | --help | -h) usage ;;
    *) usage >&2; exit 2 ;;
esac
