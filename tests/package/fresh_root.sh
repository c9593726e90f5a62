#!/usr/bin/env bash
# fresh_root.sh SOURCE BUILD [apt]: the packages of BUILD, made, looked at by lintian, installed into a root of their own, used there, and
# taken out again. The root is this system as it is, laid under a folder that takes all changes, with SOURCE hidden: what is not in the
# packages or in those that they ask for is not there. With `apt` it is a new Debian by debootstrap, and apt brings what they ask for.
# 77: there is something missing to do so, and the output says what.
set -euo pipefail
source=$1 build=$2 how=${3:-overlay}
skip() { echo "skipped: $*"; exit 77; }
for tool in dpkg-deb dpkg-shlibdeps; do
    command -v $tool >/dev/null || skip "no dpkg-dev (Debian: apt-get install dpkg-dev)"
done
[ "$(id -u)" -eq 0 ] || skip "another root takes root's rights"
if [ -z "${WEIR_IN_NAMESPACE:-}" ]; then  # mounts of its own, which go when it ends
    unshare -m true 2>/dev/null || skip "no mounts are allowed here"
    work=$(mktemp -d /var/tmp/weir-root.XXXXXX)
    trap 'rm -rf --one-file-system "$work"' EXIT
    code=0
    WEIR_IN_NAMESPACE=$work unshare -m "$0" "$@" || code=$?
    exit "$code"
fi
work=$WEIR_IN_NAMESPACE root=$work/root
mkdir -p "$work"/{root,upper,work}
if [ "$how" = apt ]; then
    debootstrap --variant=minbase "$(. /etc/os-release && echo "$VERSION_CODENAME")" "$root" "${WEIR_MIRROR:-http://deb.debian.org/debian}" >"$work/debootstrap.log" 2>&1 ||
        { tail -5 "$work/debootstrap.log"; skip "no mirror of Debian can be reached"; }
    cp /etc/apt/apt.conf.d/*proxy* "$root/etc/apt/apt.conf.d/" 2>/dev/null || true
else
    mount -t overlay overlay -o "lowerdir=/,upperdir=$work/upper,workdir=$work/work" "$root" 2>/dev/null || skip "no overlay can be mounted here"
    mount -t tmpfs tmpfs "$root$source"
fi
mount -t proc proc "$root/proc"
mount -t sysfs sysfs "$root/sys"
mount --rbind /dev "$root/dev"
mkdir -p "$root/packages" "$root/home/user"

cd "$build"
cpack -G DEB -B "$work/packages" -D CPACK_DEBIAN_COMPRESSION_TYPE="${WEIR_COMPRESSION:-gzip}" >"$work/cpack.log" 2>&1 || { tail -20 "$work/cpack.log"; exit 1; }
cp "$work"/packages/*.deb "$root/packages"
for package in weir weir-view libweir-dev python3-weir; do
    ls "$root"/packages/${package}_*.deb >/dev/null || { echo "there is no package $package"; exit 1; }
done
if command -v lintian >/dev/null; then
    # One stands for all here: they come from one template, and ./weir.sh package looks at each. Who builds packages to give away names himself (WEIR_MAINTAINER); the address that stands there otherwise is none.
    lintian --fail-on error --allow-root --suppress-tags bogus-mail-host,bogus-mail-host-in-debian-changelog "$root"/packages/weir_*.deb >"$work/lintian.log" ||
        { grep '^E:' "$work/lintian.log"; exit 1; }
else
    echo "lintian is not installed: the packages were not checked"
fi

inside() { chroot "$root" /usr/bin/env -i PATH=/usr/bin:/bin:/usr/sbin:/sbin HOME=/home/user OMP_NUM_THREADS=1 DEBIAN_FRONTEND=noninteractive bash -ec "cd /home/user; $1"; }
expect() { # COMMAND, WANTED
    local said
    said=$(inside "$1" 2>&1) || { echo "failed: $1"; echo "$said"; exit 1; }
    grep -qE -- "$2" <<<"$said" || { echo "$1 does not say $2 but:"; echo "$said"; exit 1; }
}
if [ "$how" = apt ]; then
    inside "apt-get update -qq; apt-get install -y -qq --no-install-recommends /packages/*.deb" >"$work/apt.log" 2>&1 || { tail -20 "$work/apt.log"; exit 1; }
else
    inside "dpkg -i /packages/*.deb" >"$work/dpkg.log" 2>&1 || { tail -20 "$work/dpkg.log"; exit 1; }  # refuses what is not there
fi
[ ! -e "$root$source/weir.sh" ] || { echo "the clone can be seen"; exit 1; }
expect "weir --version" "^weir [0-9.]+ \([0-9a-z-]+, (GNU|Clang) [0-9.]+, [A-Za-z]+"
expect "weir list cases" "^dam_break_2d"
expect "weir run dam_break_2d --set time.end=0.02 --set grid.cells=[32,16] --quiet; ls out/dam_break_2d" "grid.pvd"
expect "weir picture out/dam_break_2d --out a.png && head -c4 a.png" "PNG"
expect "weir plan dam_break_martin_moyce --error 5% --as-measured" "^weir run /usr/share/weir/cases/"
expect "weir cost --plan dam_break_2d --set grid.cells=[32,16]" "MiB|MB|bytes"
expect "weir validate hydrostatic_2d --quiet" "pass"
expect "zcat /usr/share/man/man1/weir.1.gz" "^\.SS weir run .scene. "
expect "zcat /usr/share/man/man1/weir-live.1.gz" "^\.so man1/weir\.1$"
expect "set +e; . /usr/share/bash-completion/completions/weir; COMP_WORDS=(weir run dam_break_2); COMP_CWORD=2; _weir; echo \${COMPREPLY[*]}" "dam_break_2d"
expect "set +e; . /usr/share/bash-completion/completions/weir; COMP_WORDS=(weir run --rest); COMP_CWORD=2; _weir; echo \${COMPREPLY[*]}" "^--restart$"
expect "python3 -c 'import weir; s = weir.Simulation(\"dam_break_2d\", set={\"grid.cells\": [32, 16], \"time.end\": 0.01}); s.run(); print(s[\"pressure\"].shape, weir.__file__)'" \
    "^\(32, 16\) /usr/lib/python3/dist-packages/weir/"
expect "weir view --help" "weir view"
expect "test -x /usr/bin/weir-view && test -x /usr/bin/weir-live && ls /usr/lib/cmake/weir/ /usr/lib/*/cmake/weir/ 2>/dev/null || true" "weirConfig.cmake"
inside "dpkg -r python3-weir weir-view libweir-dev weir" >/dev/null
expect "ls /usr/bin /usr/share /usr/include /usr/lib/python3/dist-packages | grep -c weir || true" "^0$"
(cd "$root/packages" && ls -s --block-size=K -- *.deb)
