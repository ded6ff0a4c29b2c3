# Thin: every target is one command that can be typed by hand. `make` builds the programs into
# build/tools/ and build/samples/, `make test` the tests too.
.PHONY: all pictures package test demo population check tidy sanitize install format man bench bench-rivals validation figure4 accuracy fuzz hard soak accuracy-cost presets compare-builds nightly clean

all:
	@scripts/build release programs

test:
	@scripts/build release
	@scripts/test build

demo:
	@scripts/build release programs
	@$(MAKE) --no-print-directory -C samples/demo

population:
	@scripts/build release programs
	@$(MAKE) --no-print-directory -C samples/population

check:
	@scripts/setup --check || true
	@scripts/check

# clang-tidy over the library and the programs, each finding an error.
tidy: all
	@scripts/tidy

# The tests of the library, hard cases among them, under the address, undefined-behaviour and thread
# sanitizers.
sanitize:
	@scripts/sanitize address
	@scripts/sanitize threads

install: all
	@cmake --install build $(if $(PREFIX),--prefix $(PREFIX))

format:
	@scripts/format

man:
	@scripts/build release man

accuracy:
	@scripts/build release programs
	@scripts/accuracy --build build --write
	@scripts/figures

fuzz:
	@scripts/fuzz

bench:
	@scripts/build release
	@scripts/bench build

# Our cloth beside other programs on the scenes of a folder: make bench-rivals SCENES=FOLDER
bench-rivals:
	@scripts/build release bench_rivals
	@scripts/bench-rivals $(SCENES)

# Every physical validation, the slow ones too, with what each measured beside its reference, and
# their plots.
validation:
	@scripts/setup --check gnuplot-nox
	@scripts/build release test_validation
	@cmake -E rm -rf build/validation-plots && cmake -E make_directory build/validation-plots
	@SLOPER_VALIDATION=1 SLOPER_FIGURES=1 SLOPER_PLOTS=build/validation-plots build/tests/validation/test_validation
	@scripts/validation-plots build/validation-plots docs/validation.png

# Every hard case over its sweep and 20 seeds; the table goes to docs/hard-cases.md. Runs are kept
# in build/hard-runs, which a new build empties.
hard:
	@scripts/build release run-hard
	@[ ! build/tests/hard/run-hard -nt build/hard-runs ] || rm -f build/hard-runs
	@build/tests/hard/run-hard --jobs $(shell nproc) --kept build/hard-runs --table docs/hard-cases.md; status=$$?; scripts/figures; exit $$status

# 10,000 random scenes; what fails is made small and kept in build/soak. FROM and COUNT choose a
# slice.
FROM ?= 0
COUNT ?= 10000
soak:
	@scripts/build release run-soak
	@build/tests/hard/run-soak --from $(FROM) --count $(COUNT) --out build/soak

# What .ci/run has no time for: sanitizers whole, fuzzing, hard cases, soak, builds compared,
# clang-tidy, validation, packages, a population.
nightly:
	@scripts/nightly

# The hard cases' final states in builds by other compilers, compared.
compare-builds:
	@scripts/setup --check || true
	@scripts/compare-builds

# What accuracy costs: whole drapes from panels of samples and of GARMENTS (pattern files, on the
# scan BODY), from STARTS that differ by a micrometre; and what small changes move, into
# docs/accuracy-from-panels.md; tables and plots of three samples, from one sewn start, into
# docs/accuracy-cost.md.
SCENES ?= skirt shirt trousers
STARTS ?= 5
accuracy-cost:
	@scripts/setup --check gnuplot-nox
	@scripts/build release scan-landmarks pattern-mesh drape make-mannequin make-pattern
	@for scene in $(SCENES); do scripts/accuracy-cost $$scene || exit; done
	@scripts/accuracy-cost --gather docs $(SCENES)
	@scripts/accuracy-from-panels --starts $(STARTS) $(if $(BODY),--body $(BODY)) --into docs/accuracy-from-panels.md shirt skirt trousers $(GARMENTS)
	@scripts/small-changes --into docs/accuracy-from-panels.md
	@scripts/figures

# The presets again from the measured front, into lib/garment/scene/preset_table.hpp: the cheapest
# settings within each preset's error on all scenes.
presets:
	@scripts/build release scan-landmarks pattern-mesh drape make-mannequin make-pattern
	@for scene in $(SCENES); do scripts/accuracy-cost --knobs grid $$scene || exit; done
	@scripts/accuracy-cost --derive build/accuracy-cost $(SCENES)

# The paper's Figure 4: ten drapes of the four-panel skirt, a sheet of pictures, and checks.
figure4:
	@scripts/build release programs measure-hem
	@$(MAKE) --no-print-directory -C samples/figure4

clean:
	@cmake -E rm -rf build build-dev build-sanitize build-threads build-compare
	@$(MAKE) --no-print-directory -C samples/demo clean

pictures: all
	@scripts/setup --check gnuplot-nox
	@scripts/make-pictures build

package: all
	@scripts/package-test build
