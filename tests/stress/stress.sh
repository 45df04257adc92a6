#!/bin/sh
# make stress: what takes too long for every change.
set -eu
cd "$(dirname "$0")/../.."
seconds=${FUZZ_SECONDS:-60}

echo "TSan"
cmake --preset tsan --log-level=WARNING >/dev/null
cmake --build --preset tsan
env -u SVDAG_SCENES ctest --test-dir build/tsan -L '^unit$' --output-on-failure

echo "Families: 10^7 decisions per family, grid and rule"
cmake --preset release --log-level=WARNING >/dev/null
cmake --build --preset release --target stress_test
SVDAG_STRESS_DECISIONS=${DECISIONS:-10000000} build/release/tests/stress_test --gtest_brief=1

echo "Every compiler and flag gives the same bytes"
bash tests/stress/one_hash.sh

echo "Completion by bash, fish and zsh"
cmake --build --preset release --target svdag_manuals
ctest --test-dir build/release -R '^completion$' --output-on-failure

echo "Faults from outside: every call, small disks, signals, kills, power cuts, little memory"
cmake --build --preset release --target svdag svdag-scene svdag_fault_shim
SVDAG_LONG=1 ctest --test-dir build/release -L '^fault$' --timeout 14400 --output-on-failure

echo "The page of a report, in Chromium"
cmake --build --preset release
/usr/bin/python3 -B tests/stress/report_shot.py build/release build/report_shots

echo "The packages, in a clean Debian"
(cd build/release && cpack -G DEB -B ../deb >/dev/null)
sh tests/stress/deb_test.sh build/release build/deb

echo "Fuzzers, $seconds s each"
cmake --preset fuzz --log-level=WARNING >/dev/null
cmake --build --preset fuzz --target fuzzers
/usr/bin/python3 -B tests/fuzz/long_run.py --seconds "$seconds"
echo "All of it passed."
