#!/bin/sh
# Downloads ufbx, which reads FBX and is no package of Debian, into the folder $1: ufbx.c, ufbx.h and LICENSE of version
# 0.21.2, from the source archive of the Python package pyufbx, whose SHA-256 is checked. Does nothing if they are there.
# Without a connection it says so and exits with 0: the build then reads no FBX.
set -eu
folder=$1
[ ! -e "$folder/ufbx.c" ] || exit 0
work=$folder/download
rm -rf "$work"
mkdir -p "$work"
echo "pyufbx==0.0.7 --hash=sha256:aabe7cb568f538719c5b7d3efc19f0f578678f99c1e5b3d52689bfc9a15e0e4b" >"$work/hash"
/usr/bin/python3 -m venv "$work/python"
if ! "$work/python/bin/pip" download -q --disable-pip-version-check --no-deps --no-binary pyufbx -r "$work/hash" \
    -d "$work" >"$work/log" 2>&1; then
  tail -n 1 "$work/log" >&2
  echo "ufbx cannot be downloaded: this build will not read FBX files" >&2
  exit 0
fi
tar -xzf "$work/pyufbx-0.0.7.tar.gz" -C "$work"
source=$work/pyufbx-0.0.7
mv "$source/ufbx-c/ufbx.h" "$source/LICENSE" "$folder"
mv "$source/ufbx-c/ufbx.c" "$folder"  # last: it stands for all
rm -rf "$work"
