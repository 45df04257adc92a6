#!/bin/sh
# make stress: the tests that take too long to run for every change. STAGES selects some of them:
# make stress STAGES="tsan packages".
set -eu
cd "$(dirname "$0")/../.."
all="tsan families cut_outs properties one_hash arm64 completion faults report_shot packages fuzzers"
skipped=

may_skip() {  # COMMAND...: exit code 77 means that it cannot run here
  code=0
  "$@" || code=$?
  [ "$code" != 77 ] || { skipped="$skipped $stage"; return 0; }
  return "$code"
}

release() {  # [TARGET...]
  cmake --preset release --log-level=WARNING >/dev/null
  cmake --build --preset release ${1:+--target "$@"}
}

tsan() {
  cmake --preset tsan --log-level=WARNING >/dev/null
  cmake --build --preset tsan
  env -u SVDAG_SCENES ctest --test-dir build/tsan -L '^unit$' --output-on-failure --no-tests=error
}

families() {  # 10^7 decisions per family, grid and rule
  release stress_test
  SVDAG_STRESS_DECISIONS=${DECISIONS:-10000000} build/release/tests/stress_test --gtest_brief=1
}

cut_outs() {  # a million points for each grid and rule, 2500 voxels for each grid
  release svdag
  /usr/bin/python3 -B tests/io/scene/cutouts/points_test.py build/release 1000000
}

properties() {  # 5000 inputs for each instead of 100
  release
  RC_PARAMS=max_success=${INPUTS:-5000} ctest --test-dir build/release --output-on-failure --no-tests=error \
    -R '^(streaming|io|help|scene|farm|generator|verify|stress)_test$'
  SVDAG_LONG=1 build/release/tests/builder_test --gtest_filter='Layers.*:Solid.*' --gtest_brief=1
  SVDAG_LONG=1 build/release/tests/colour_test --gtest_filter='ColourPass.*' --gtest_brief=1
}

one_hash() {  # the same bytes with every compiler and flag
  bash tests/stress/one_hash.sh
}

arm64() {  # under QEMU, which has no seccomp filters
  make arm64
  release svdag svdag-scene svdag-trace
  cmake --build --preset arm64 --target streaming_test io_test dag_test builder_test
  impossible='LimitedChild.*'
  # Tests that start their program again need a kernel that hands it to QEMU.
  build/arm64/svdag --version >/dev/null 2>&1 ||
    impossible="$impossible:MappedFile.AProgramWhoseFileChangedFails:MappedFile.AChangeIsReported*"
  GTEST_FILTER="-$impossible" ctest --test-dir build/arm64 -R '^(streaming|io|dag|builder)_test$' --timeout 7200 \
    --output-on-failure --no-tests=error
  /usr/bin/python3 -B tests/arm64/same_bytes.py build/release build/arm64 qemu-aarch64-static
}

completion() {  # in bash, fish and zsh
  release svdag_manuals
  ctest --test-dir build/release -R '^completion$' --output-on-failure --no-tests=error
}

faults() {  # failing system calls, full disks, signals, kills, power cuts, little memory
  release svdag svdag-export svdag-scene svdag-trace svdag-verify svdag_fault_shim svdag_float_modes
  SVDAG_LONG=1 ctest --test-dir build/release -L '^fault$' --timeout 14400 --output-on-failure --no-tests=error
}

report_shot() {  # the page of a report, in Chromium
  release
  may_skip /usr/bin/python3 -B tests/stress/report_shot.py build/release build/report_shots
}

packages() {  # in a clean Debian
  release
  rm -f build/deb/*.deb  # of another version
  (cd build/release && cpack -G DEB -B ../deb >/dev/null)
  may_skip sh tests/stress/deb_test.sh build/release build/deb
}

fuzzers() {  # FUZZ_SECONDS each
  cmake --preset fuzz --log-level=WARNING >/dev/null
  cmake --build --preset fuzz --target fuzzers
  /usr/bin/python3 -B tests/fuzz/long_run.py --seconds "${FUZZ_SECONDS:-60}"
}

for stage in ${*:-$all}; do
  case " $all " in
    *" $stage "*) ;;
    *) echo "stress: unknown stage \"$stage\" (stages: $all)" >&2; exit 2 ;;
  esac
done
for stage in ${*:-$all}; do
  began=$(date +%s)
  echo "$stage"
  "$stage"
  case "$skipped" in *" $stage") continue ;; esac
  echo "$stage passed in $((($(date +%s) - began + 30) / 60)) min"
done
if [ -n "$skipped" ]; then
  echo "Passed. Skipped because they cannot run here:$skipped."
else
  echo "All stages passed."
fi
