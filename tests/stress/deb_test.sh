#!/bin/sh
# Tests the packages of `make deb` in a minimal, clean Debian: their dependencies are complete, the programs bake
# and verify a scene, another project builds against libsvdag-dev, and removal leaves no file behind.
# Usage: deb_test.sh PROGRAMS PACKAGES   (the folders of a finished build and of its .deb files; as root)
set -eu
cd "$(dirname "$0")/../.."
programs=$(realpath "$1")
packages=$(realpath "$2")
skip() { echo "deb_test: skipped, $1"; exit 77; }

[ "$(id -u)" = 0 ] || skip "needs root for chroot"
command -v debootstrap >/dev/null || skip "needs debootstrap"
command -v apt-get >/dev/null || skip "needs apt, to find its mirror"
# The programs name their outputs through /proc: mount it in a private namespace.
if [ -z "${SVDAG_OWN_MOUNTS:-}" ]; then
  unshare --mount true 2>/dev/null || skip "needs the right to mount"
  SVDAG_OWN_MOUNTS=1 exec unshare --mount --propagation private sh tests/stress/deb_test.sh "$programs" "$packages"
fi
. /etc/os-release
[ "$ID" = debian ] || skip "the packages are for Debian, this is $ID"

# The clean root uses the package sources of this machine.
sources=$(apt-get indextargets --format 'deb $(REPO_URI) $(RELEASE) $(COMPONENT)' 'Created-By: Packages' | sort -u)
mirror=$(echo "$sources" | awk -v suite="$VERSION_CODENAME" '$3 == suite && $4 == "main" { print $2; exit }')
[ -n "$mirror" ] || skip "apt has no mirror of $VERSION_CODENAME"

work=$(mktemp -d)
root=$work/root
trap 'umount "$root"/proc 2>/dev/null || true; rm -rf --one-file-system "$work"' EXIT
trap 'exit 130' INT TERM
log=$work/log
fail_with_log() { tail -20 "$log" >&2; exit 1; }

echo "a clean $PRETTY_NAME"
debootstrap --variant=minbase "$VERSION_CODENAME" "$root" "$mirror" >"$log" 2>&1 || fail_with_log
echo "$sources" | grep -v -- '-backports ' >"$root"/etc/apt/sources.list
mountpoint -q "$root"/proc || mount -t proc proc "$root"/proc
mkdir "$root"/try
cp "$packages"/svdag_*.deb "$packages"/libsvdag-dev_*.deb "$root"/try
cp -r tests/package/reader "$root"/try
"$programs"/svdag-scene city -n 6K -q -o "$root"/try/city.ply  # svdag-scene is not packaged

cat >"$root"/try/install.sh <<'INSIDE'
set -eu
export DEBIAN_FRONTEND=noninteractive
cd /try
apt-get -qq update
dpkg-query -W -f '${Package}\n' | sort >before
apt-get -qq install -y --no-install-recommends ./svdag_*.deb
INSIDE
cat >"$root"/try/use.sh <<'INSIDE'
set -eu
cd /try
svdag --version
svdag build city.ply -r 256 -o city.svdag -q --report city.json
svdag info city.svdag >info
head -3 info
svdag-verify check city.svdag
svdag-verify mesh city.svdag city.ply -q
svdag-verify render city.svdag -o city.png --size 64x36 -q
svdag-verify report city.svdag city.json -o city.html --size 64x36 -q
svdag export city.svdag -o city.vdb -q
svdag-verify vdb city.svdag city.vdb -q
svdag export city.svdag --format symvox -o symvox.svdag -q
svdag import symvox.svdag -o again.svdag -q
svdag-trace city.svdag --size 32x32 --samples 4 --rounds 1 >/dev/null
for file in city.png city.html again.svdag; do test -s $file; done
INSIDE
cat >"$root"/try/develop.sh <<'INSIDE'
set -eu
export DEBIAN_FRONTEND=noninteractive
cd /try
apt-get -qq install -y --no-install-recommends ./libsvdag-dev_*.deb g++ cmake make
cmake -S reader -B build >/dev/null
cmake --build build
g++ -std=c++17 -O1 -I/usr/include/svdag reader/mapped.cpp -o mapped
INSIDE
cat >"$root"/try/remove.sh <<'INSIDE'
set -eu
export DEBIAN_FRONTEND=noninteractive
cd /try
apt-get -qq purge -y svdag libsvdag-dev g++ cmake make
apt-get -qq autoremove --purge -y
dpkg-query -W -f '${Package}\n' | sort | diff before -
INSIDE
inside() { env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C chroot "$root" sh /try/"$1".sh; }

echo "install svdag with its dependencies"
inside install >"$log" 2>&1 || fail_with_log
inside use
echo "build another project with libsvdag-dev"
inside develop >"$log" 2>&1 || fail_with_log
counted=$(chroot "$root" /try/build/count_voxels /try/city.svdag)
echo "$counted voxels"
[ "$counted" = "$(chroot "$root" /try/mapped /try/city.svdag)" ] || { echo "the two readers differ" >&2; exit 1; }
echo "remove the packages"
inside remove >"$log" 2>&1 || fail_with_log
left=$(find "$root"/usr "$root"/etc "$root"/var/lib -name '*svdag*' -not -path '*/apt/*')
[ -z "$left" ] || { echo "left behind: $left" >&2; exit 1; }
echo "deb_test: ok"
