# make         builds Singe into build/
# make demo    installs what it needs (Debian, Ubuntu), builds the program, burns the letter and says where its video is
# make pictures  draws the pictures of the documentation again, after make build
# make test    builds what the unit tests need, and runs them; PRESET=dev: with assertions
# make check   installs, builds and runs every test; the last thing printed is the test runner's summary
# make fuzz-long HOURS=8, make soak HOURS=1: what runs for as long as it is let

FUZZ_SECONDS ?= 30
DEMO_DIR ?= out/letter

# tests that measure, for a minute or more under a sanitizer, on code that others go through there
MEASURING = bending|cli_paper|cli_paper_parts|cli_materials|cli_bench|heat_front
# check-examples has them: together they would take longer than all the rest
LONG = platforms|presets|isotropy|fold|spread|cli_validate|cli_materials|example_(SameBytes|HotSphere|Stack|LetterHanging|PageHot|HotIron|Tear|Shirt|BurningTorus|StackEdge|Newspaper|Curtain|CrumpledBall)

# tests of what stands outside those folders, or of how fast it is
NO_COVERAGE = torture|mesh_zoo|mesh_gate|cli_wrinkles|cli_rim|cli_crossings|cli_validate|cli_paper_.*|step_cost|step_instructions|front|spread|install

# of make fuzz-long and of make soak
HOURS ?= 1
MINUTES ?= $(shell echo $(HOURS) | awk '{print 60 * $$1}')

PRESET ?= release

.PHONY: all configure demo test check check-examples check-blender check-clients check-platforms check-farm check-packages check-mpi gate torture coverage fuzz-long soak pictures build build-asan build-fuzz build-shared build-tsan clean

all: build

build:
	cmake --preset release
	cmake --build --preset release

# all of them at once: each takes one core
configure:
	printf '%s\n' release asan fuzz shared tsan | xargs -P $$(nproc) -n 1 cmake --preset

build-asan:
	cmake --preset asan
	cmake --build --preset asan

build-fuzz:
	cmake --preset fuzz
	cmake --build --preset fuzz

# without the preview and with only the public names to see, the command still builds
build-shared:
	cmake --preset shared
	cmake --build --preset shared

# what threads share, under the thread sanitizer
build-tsan:
	cmake --preset tsan
	cmake --build --preset tsan --target threaded_tests

demo:
	scripts/setup.sh
	cmake --preset release
	cmake --build --preset release --target singe_program
	build/singe run examples/letter/letter.yaml -o $(DEMO_DIR) $(DEMO_FLAGS)
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
	ctest --preset asan -j2 -E '^($(MEASURING))$$'
	tests/fuzz/run.sh build-fuzz $(FUZZ_SECONDS)
	ctest --preset release -j2 -E '^($(LONG))$$'

# every example, run whole and verified, and what takes long to measure: 40 minutes
check-examples: build
	ctest --preset release -j2 -R '^($(LONG)|example_Letter)$$'

# real models of some packages, which are got into build/gate, burnt and verified: docs/meshes.md has the table. 209 are
# clean or cross themselves in the file; one more that is strained, refused or fails is a fault
gate: build
	tests/gate/gate.py --singe build/singe --folder build/gate --least 209 --failed 0

# other programs, which are installed into build/clients, on what a burn leaves: docs/usd.md and others have the table
check-clients: build
	tests/clients/check.sh build/singe build/clients

# the extension in Blender 4.5 and 5.2: WHEELS=FOLDER installs it with its program, too
check-blender: build
	bindings/blender/tests/check.sh build/singe build/blender $(WHEELS)

# a sweep on a Slurm of one node, preempted and resumed: needs root
check-farm: build
	tests/farm/check_slurm.py build/singe --install

# the prototype of one sheet on several nodes, on the ranks of this machine
check-mpi:
	tests/farm/check_mpi.py --install

# packages on bare Debian 12 and 13, the static command, the Conan recipe: needs root and debootstrap
check-packages: build
	tests/packages/check.py

# the core on Windows, 64-bit Arm Linux and macOS: compilers and emulators are installed, and what runs has the same bytes
check-platforms:
	tests/platforms/check.py --source . --build build/platforms --install

# every allocation, write, open, ... of whole commands fails once: hours; Ctrl-C ends it with its table
torture:
	cmake --preset release
	cmake --build --preset release --target torture

# how much of src, formats, scene and mesh the tests reach, by folder; docs/coverage.md says what they leave and why
coverage:
	scripts/setup.sh
	cmake --preset coverage
	cmake --build --preset coverage
	find build-coverage -name '*.gcda' -delete
	-ctest --preset coverage -j2 -E '^($(MEASURING)|$(NO_COVERAGE)|example_.*)$$'
	scripts/coverage.py build-coverage

# all fuzz targets for HOURS, two at a time; what they find and their corpora stay in build-fuzz/fuzz. Then how much of
# each folder these corpora reach
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

# random scenes for HOURS, or MINUTES, under the sanitizers: check, run, verify, resume; findings stay in build-asan/soak
soak: build-asan
	tests/soak/soak.py build-asan/singe build-asan/tests/soak/draw_scene --minutes $(MINUTES) \
	    --seed $${SEED:-$$(date +%s)} --work build-asan/soak

pictures:
	scripts/draw_gallery.sh

clean:
	rm -rf build build-asan build-tsan build-fuzz build-shared build-coverage build-dev
