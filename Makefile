# make            builds Singe into build/
# make demo       installs what it needs (Debian, Ubuntu), builds the command, burns the note and prints its video's path
# make test       builds and runs the unit tests; PRESET=dev: with assertions
# make check      installs what it needs, builds everything and runs the tests
# make pictures   draws the pictures of the documentation again, after make build
# make fuzz-long HOURS=8, make soak HOURS=1: search for faults as long as you like
# docs/testing.md describes the other targets; tests/CMakeLists.txt explains the labels of tests.

FUZZ_SECONDS ?= 30
DEMO_DIR ?= out/note
PRESET ?= release

# of make fuzz-long and make soak
HOURS ?= 1
MINUTES ?= $(shell echo $(HOURS) | awk '{print 60 * $$1}')

.PHONY: all web-package build build-asan build-fuzz build-shared build-tsan configure demo test check \
        check-examples gate site check-clients check-godot check-unity check-unreal check-blender check-farm \
        check-packages check-platforms web web-serve web-pictures web-speed check-web check-web-size \
        check-web-core check-web-examples torture mutations coverage fuzz-long soak pictures bench-peers clean

all: build

build:
	cmake --preset release
	cmake --build --preset release

# configures all presets in parallel; each uses one core
configure:
	printf '%s\n' release asan fuzz shared tsan | xargs -P $$(nproc) -n 1 cmake --preset

build-asan:
	cmake --preset asan
	cmake --build --preset asan

build-fuzz:
	cmake --preset fuzz
	cmake --build --preset fuzz --target fuzz_targets

# the command on a shared library that exports the public names only
build-shared:
	cmake --preset shared
	cmake --build --preset shared

build-tsan:
	cmake --preset tsan
	cmake --build --preset tsan --target threaded_tests

# Smaller pictures, without lens and shutter, which would take most of the time. `singe render out/note` draws them
# whole.
DEMO_LOOK = --set preview.size=[640,360] --set preview.camera.aperture=0 --set preview.shutter=0 --set preview.samples=13

demo:
	scripts/setup.sh
	cmake --preset release
	cmake --build --preset release --target singe_program
	build/singe run examples/note/note.yaml -o $(DEMO_DIR) --force $(DEMO_LOOK) $(DEMO_FLAGS)
	@echo "the video: $$(realpath $(DEMO_DIR)/preview.mp4)"

test:
	cmake --preset $(PRESET)
	cmake --build --preset $(PRESET) --target unit_tests
	ctest --preset $(PRESET) -j2 -L '^unit$$'

check:
	scripts/setup.sh --check
	scripts/check_arrows.sh
	$(MAKE) configure
	$(MAKE) build build-asan build-fuzz build-shared build-tsan
	build-shared/singe --version
	ctest --preset tsan -j2 -L '^threads$$'
	ctest --preset asan -j2 -LE '^measuring$$'
	tests/fuzz/run.sh build-fuzz $(FUZZ_SECONDS)
	ctest --preset release -j2 -LE '^long$$'

# burns and verifies every example, and runs the tests that make check leaves out: 42 minutes
check-examples: build
	ctest --preset release -j2 -L '^(long|example)$$'

# downloads real models of several packages into build/gate, burns and verifies them; docs/meshes.md has the table.
# Fails if one fails, or if fewer than 209 are clean apart from crossings that are in the file already.
gate: build
	tests/gate/gate.py --singe build/singe --folder build/gate --least 209 --failed 0

# installs other programs into build/clients, and checks that they read the output of a burn; docs/usd.md and others
# have the table
check-clients: build
	tests/clients/check.sh build/singe build/clients

# the node SingeSheet in Godot 4: $GODOT, or Debian's package of it, which root unpacks into build/clients/godot
check-godot: build
	tests/clients/godot.py build/singe build/clients/godot

# the script and the plug-in for Unity, by Mono and without Unity
check-unity:
	tests/clients/unity.py build/clients/unity

# the component for Unreal, without Unreal
check-unreal:
	tests/clients/unreal.py build/clients/unreal

# the extension in Blender 4.5 and 5.2; WHEELS=FOLDER also installs it together with its program
check-blender: build
	bindings/blender/tests/check.sh build/singe build/blender $(WHEELS)

# preempts and resumes a sweep on a Slurm of one node, which needs root; runs one by openjd-cli, and OpenCue's frames
check-farm: build
	tests/farm/check_openjd.py build/singe build/openjd
	tests/farm/check_opencue.py build/singe build/opencue
	tests/farm/check_slurm.py build/singe --install

# packages on bare Debian 12 and 13, the static command, the Conan recipe; needs root and debootstrap
check-packages: build
	tests/packages/check.py

# the core on Windows, 64-bit Arm Linux and macOS: installs compilers and emulators, and compares the bytes of runs
check-platforms:
	tests/platforms/check.py --source . --build build/platforms --install

# the core as WebAssembly, the npm package around it (bindings/web), and the page (web) with its sizes
web: web-package
	cd web && npm ci --ignore-scripts && npm run build

web-package:
	cmake --preset wasm
	cmake --build --preset wasm --target singe_wasm singe_files_wasm singe_layout
	cd bindings/web && npm ci --ignore-scripts && npm run build
	cp build-wasm/web/singe.wasm build-wasm/web/singe-files.wasm bindings/web/dist

# the page at http://127.0.0.1:8080
web-serve: web
	cd web && node serve.mjs

# tests the page in Chromium and measures its speed; views a burn by `singe view` in Chromium and Firefox, and in
# JupyterLab
check-web: web
	cmake --preset release
	cmake --build --preset release --target singe_program singe_python
	[ -x build/notebook/bin/python ] || python3 -m venv build/notebook
	build/notebook/bin/pip install --quiet --disable-pip-version-check --require-hashes -r tests/locks/notebook.txt
	build/singe run examples/letter -o build/notebook/run --force --quiet --no-preview \
	    --set frames=12 --set sheets.0.grid.cells=[42,60]
	[ -x build/usd/bin/python ] || python3 -m venv build/usd
	build/usd/bin/pip install --quiet --disable-pip-version-check --require-hashes -r tests/locks/usd.txt
	cd web && SINGE_PROGRAM=$(CURDIR)/build/singe SINGE_USD=$(CURDIR)/build/usd/bin/python npm test
	cd web && SINGE_PROGRAM=../build/singe SINGE_LIBRARY=$(CURDIR)/build/python/singe/libsinge.so \
	    PYTHONPATH=../bindings/python node tests/notebook.mjs ../build/notebook/bin/python ../build/notebook/run
	cd web && SINGE_PROGRAM=$(CURDIR)/build/singe SINGE_LIBRARY=$(CURDIR)/build/python/singe/libsinge.so \
	    PYTHONPATH=$(CURDIR)/bindings/python node tests/jupyterlab.mjs ../build/notebook/bin/python ../build/notebook/run

# the page's size, and its speed in Chromium; with CACHE, a large one, that of `singe view` as well, which needs
# build/singe
web-speed: web
	cd web && ONLY=speed node tests/check.mjs
	[ -z "$(CACHE)" ] || node web/tests/large.mjs $(CACHE)

# pictures of the page for docs/web.md, its first minute among them, into build/web-pictures; with CACHE=out/letter
# those of docs/view.md as well, which need build/singe
web-pictures: web
	cd web && ONLY="first minute|letter burns by itself|each scene|axe" node tests/check.mjs --pictures ../build/web-pictures
	cd build/web-pictures && for name in letter settings; do ffmpeg -y -loglevel error -i $$name.png -q:v 3 web-$$name.jpg; done
	[ -z "$(CACHE)" ] || node web/tests/pictures.mjs $(CACHE) build/web-pictures
	cd build/web-pictures && ffmpeg -y -loglevel error -i minute-1-page.png -i minute-2-match.png -i minute-3-hole.png \
	    -i minute-4-torn.png -i minute-5-link.png -filter_complex "[0]scale=640:400[a];[1]scale=640:400[b];[2]scale=640:400[c]; \
	    [a][b][c]hstack=3[u];[3][4]hstack[v];[u][v]vstack" -quality 82 web-minute.webp
	cd build/web-pictures && for name in torus corners stack title ember curtain; do \
	    ffmpeg -y -loglevel error -i scene-$$name.png -vf crop=600:400:170:95 small-$$name.png; done
	cd build/web-pictures && ffmpeg -y -loglevel error -i small-torus.png -i small-corners.png -i small-stack.png -i small-title.png \
	    -i small-ember.png -i small-curtain.png -filter_complex "[0][1][2]hstack=3[u];[3][4][5]hstack=3[v];[u][v]vstack,scale=1500:-1" \
	    -quality 82 web-scenes.webp

# the documentation as a site in build/site/html, with references made from the headers and the docstrings: needs
# doxygen; Sphinx is installed into build/site. Warnings and dead links are errors. Where `make web` was run, its page
# is inside
site:
	cmake --preset release
	cmake --build --preset release --target singe_python
	[ -x build/site/venv/bin/sphinx-build ] || python3 -m venv build/site/venv
	build/site/venv/bin/pip install --quiet --disable-pip-version-check --require-hashes -r tests/locks/site.txt
	mkdir -p build/site/doxygen
	doxygen docs/site/Doxyfile
	SINGE_LIBRARY=$(CURDIR)/build/python/singe/libsinge.so build/site/venv/bin/sphinx-build --quiet --fresh-env --fail-on-warning \
	    -c docs/site -d build/site/doctrees . build/site/html
	docs/site/check.py build/site/html

# the core as WebAssembly alone, without Node.js: at most 200 kB gzipped
check-web-size:
	cmake --preset wasm
	cmake --build --preset wasm --target singe_wasm
	@size=$$(gzip -9c build-wasm/web/singe.wasm | wc -c); echo "singe.wasm: $$size bytes gzipped"; [ $$size -le 200000 ]

# tests the package in node; its burn must have the bytes of the native library
check-web-core: web-package
	cmake --preset portable
	cmake --build --preset portable --target hash_runs
	cd bindings/web && SINGE_NATIVE=$(CURDIR)/build-portable/tests/platforms/hash_runs npm test && node tests/speed.mjs

# the first 48 frames of every example at a small size: recorded here, replayed in node by the core as WebAssembly
check-web-examples:
	cmake --preset release -B build/portable-program -DSINGE_PORTABLE_MATH=ON -DSINGE_TESTS=OFF
	cmake --build build/portable-program --target singe_program
	cmake --preset wasm -B build/wasm-replay -DSINGE_RECORDING=ON
	cmake --build build/wasm-replay --target hash_runs
	node --no-warnings bindings/web/tests/examples.mjs build/portable-program/singe build/wasm-replay/tests/platforms/hash_runs build/web-examples

# makes each allocation, write and open of whole commands fail once. Takes hours; Ctrl-C ends it and prints its table
torture:
	cmake --preset release
	cmake --build --preset release --target torture

# changes lines of the core one at a time; the test named for each change must fail
mutations:
	scripts/setup.sh
	tests/mutations/mutations.py

# measures a swinging and a falling sheet in this solver and in others, and prints the tables of docs/performance.md;
# NVCLOTH=FOLDER, where NvCloth's sources are, measures them in NvCloth as well
bench-peers: build
	scripts/bench_peers.py build/singe --table $(if $(NVCLOTH),--nvcloth $(NVCLOTH))

# how much of each folder of src, program/formats and program/scene the tests reach; docs/coverage.md lists the rest
coverage:
	scripts/setup.sh
	cmake --preset coverage
	cmake --build --preset coverage
	find build-coverage -name '*.gcda' -delete
	-ctest --preset coverage -j2 -LE '^(measuring|no-coverage|example)$$'
	scripts/coverage.py build-coverage

# Runs all fuzz targets for HOURS, two at a time; findings and corpora stay in build-fuzz/fuzz. Then prints how much of
# each folder these corpora reach.
fuzz-long: build-fuzz
	tests/fuzz/run.sh build-fuzz $(HOURS)h
	cmake --preset coverage
	cmake --build --preset coverage --target fuzz_targets
	find build-coverage -name '*.gcda' -delete
	for target in build-fuzz/fuzz/*/; do \
	    name=$$(basename $$target); \
	    build-coverage/tests/fuzz/fuzz_$$name $$target/corpus tests/fuzz/seeds/$$name 2>/dev/null || exit 1; \
	done
	scripts/coverage.py build-coverage --no-bars

# checks, runs, verifies and resumes random scenes under the sanitizers for HOURS or MINUTES, half of them at the limits
# of what is legal; findings stay in build-asan/soak*
soak: build-asan
	code=0; for kind in "" --extremes; do \
	    tests/soak/soak.py build-asan/singe build-asan/tests/soak/draw_scene $$kind --seed $${SEED:-$$(date +%s)} \
	        --minutes $$(echo $(MINUTES) | awk '{print $$1 / 2}') --work build-asan/soak$$kind || code=1; \
	done; exit $$code

pictures:
	scripts/draw_gallery.sh

clean:
	rm -rf build build-asan build-tsan build-fuzz build-shared build-coverage build-dev
