# libaset: `make help` lists the targets.
.DEFAULT_GOAL := all
.DELETE_ON_ERROR:

VERSION := $(shell sed -n 's/^\#define ASET_VERSION "\(.*\)"/\1/p' include/aset/config.h)
SOVERSION := $(shell sed -n 's/^\#define ASET_ABI //p' include/aset/config.h)
PREFIX ?= /usr/local
LIBDIR ?= $(PREFIX)/lib
BUILD ?= build
# Make parts words at blanks, and so does pkg-config: a folder with one in its name can be DESTDIR alone.
one_word = $(if $(word 2,$($(1))),$(error $(1)=$($(1)): expected a name without blanks))
$(call one_word,BUILD)

# make V=1 shows the commands.
ifeq ($(V),)
Q := @
say = @echo "  $(1)  $@"
else
Q :=
say =
endif

CC ?= cc
CXX ?= c++
AR ?= ar
CFLAGS ?= -O2 -g
# No contraction: pictures and counts are the same on every machine only if a * b + c is rounded twice everywhere. Nobody reads errno
# after a root: so several are drawn at once.
STRICT := -std=c99 -Wall -Wextra -pedantic -Wconversion -Wshadow -Wmissing-prototypes -ffp-contract=off -fno-math-errno -Iinclude -Ilib
POSIX := -D_POSIX_C_SOURCE=200809L
PNG_CFLAGS = $(shell pkg-config --cflags libpng)
PNG_LIBS = $(shell pkg-config --libs libpng)
CMOCKA_CFLAGS = $(shell pkg-config --cflags cmocka)
CMOCKA_LIBS = $(shell pkg-config --libs cmocka)

CORE := $(wildcard lib/base/*.c lib/scene/*.c lib/space/*.c lib/approx/*.c lib/trace/*.c)
LOAD := $(wildcard lib/load/*.c)
PROCEDURAL := $(wildcard lib/procedural/*.c)
TOOL := $(wildcard tools/*.c)
TESTS := $(patsubst tests/%.c,%,$(wildcard tests/test_*.c)) test_draft_narrow
# planned.c is compiled with a header that a plan writes: tests/plan.sh
EXAMPLES := $(patsubst examples/%.c,%,$(filter-out examples/planned.c,$(wildcard examples/*.c)))
objects = $(patsubst %.c,$(BUILD)/$(2)/%.o,$(1))

CORE_A := $(BUILD)/libaset.a
LOAD_A := $(BUILD)/libaset_load.a
PROCEDURAL_A := $(BUILD)/libaset_procedural.a
ARCHIVES := $(PROCEDURAL_A) $(LOAD_A) $(CORE_A)
SHARED := $(BUILD)/libaset.so.$(VERSION)

all: $(ARCHIVES) $(SHARED) $(BUILD)/aset examples ## build everything: libraries, tool, examples

# Other switches than the last time: all is compiled anew, or the objects would not fit together.
SWITCHES := $(filter -DASET_%,$(CPPFLAGS) $(CFLAGS))
# What a program of the tests has to be compiled with to go with this library.
LIKE_THE_LIBRARY = $(SWITCHES) $(filter -fsanitize=% --coverage,$(CFLAGS))
$(BUILD)/switches: FORCE
	@mkdir -p $(@D)
	@echo '$(SWITCHES)' | cmp -s - $@ || echo '$(SWITCHES)' > $@

$(BUILD)/obj/tools/%.o: EXTRA = $(POSIX) $(PNG_CFLAGS)
# GCC 12 fuses a * b + c in what it vectorizes there, whatever -ffp-contract says, where the machine can.
$(BUILD)/obj/lib/procedural/%.o $(BUILD)/pic/lib/procedural/%.o: EXTRA = -fno-tree-slp-vectorize
$(BUILD)/obj/%.o: %.c $(BUILD)/switches
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(CPPFLAGS) $(STRICT) $(CFLAGS) $(EXTRA) -MMD -MP -c $< -o $@
$(BUILD)/pic/%.o: %.c $(BUILD)/switches
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(CPPFLAGS) $(STRICT) $(CFLAGS) $(EXTRA) -fPIC -fvisibility=hidden -MMD -MP -c $< -o $@

$(CORE_A): $(call objects,$(CORE),obj)
$(LOAD_A): $(call objects,$(LOAD),obj)
$(PROCEDURAL_A): $(call objects,$(PROCEDURAL),obj)
$(ARCHIVES):
	$(call say,AR)
	@rm -f $@
	$(Q)$(AR) rcs $@ $^

$(SHARED): $(call objects,$(CORE) $(LOAD) $(PROCEDURAL),pic)
	$(call say,LD)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -shared -Wl,-soname,libaset.so.$(SOVERSION) -o $@ $^ -lm

$(BUILD)/aset: $(call objects,$(TOOL),obj) $(ARCHIVES)
	$(call say,LD)
	$(Q)$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $^ $(PNG_LIBS) -lpthread -lm

# --- examples: each is one file and the libraries, with the public headers only ---

$(BUILD)/examples/%: examples/%.c $(wildcard examples/*.h) $(ARCHIVES)
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(CPPFLAGS) -std=c99 -Wall -Wextra -pedantic -Wshadow $(POSIX) $(CFLAGS) $(LDFLAGS) -ffp-contract=off -Iinclude -I$(@D) \
	  $(PNG_CFLAGS) -o $@ $< $(ARCHIVES) $(PNG_LIBS) -lm

# The draft that the program on a microcontroller has in its flash.
$(BUILD)/examples/flash: $(BUILD)/examples/flash_model.h
$(BUILD)/examples/flash_model.h: $(BUILD)/aset
	@mkdir -p $(@D)
	$(call say,BAKE)
	$(Q)$(BUILD)/aset scene skull -o $(@D)/skull.nff
	$(Q)$(BUILD)/aset bake $(@D)/skull.nff --grid 40 --name model --quiet -o $@

examples: $(addprefix $(BUILD)/examples/,$(EXAMPLES)) ## build the examples

mpi: $(BUILD)/cluster/mpi_render ## the example for a cluster (needs Open MPI: make deps-cluster)
$(BUILD)/cluster/mpi_render: examples/cluster/mpi_render.c $(ARCHIVES)
	@mkdir -p $(@D)
	$(call say,MPICC)
	$(Q)mpicc $(CPPFLAGS) -std=c99 -Wall -Wextra -pedantic -Wshadow $(POSIX) $(CFLAGS) $(LDFLAGS) -ffp-contract=off -Iinclude -o $@ $< $(ARCHIVES) -lm

# --- tests ---

TOOL_TESTABLE := $(call objects,$(filter-out tools/aset.c,$(TOOL)),obj)
$(BUILD)/tests/%: tests/%.c $(wildcard tests/support/* tests/*.h) tests/convert.c $(TOOL_TESTABLE) $(ARCHIVES)
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(CPPFLAGS) $(STRICT) $(POSIX) $(CFLAGS) $(LDFLAGS) $(CMOCKA_CFLAGS) -Itests -Itools -MMD -MP -o $@ $< \
	  $(wildcard tests/support/*.c) $(TOOL_TESTABLE) $(ARCHIVES) $(CMOCKA_LIBS) $(PNG_LIBS) -lpthread -lm

$(BUILD)/tests/determinism: tests/determinism.c $(ARCHIVES)
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(CPPFLAGS) $(filter-out -Ilib,$(STRICT)) $(CFLAGS) $(LDFLAGS) -o $@ $< $(PROCEDURAL_A) $(LOAD_A) $(CORE_A) -lm

# The same tests of what beams do where no processor's wide registers are taken.
$(BUILD)/tests/test_draft_narrow: tests/test_draft.c lib/approx/draft_beam.c lib/approx/draft_shadows.c $(wildcard tests/support/*) $(ARCHIVES)
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(CPPFLAGS) $(STRICT) $(POSIX) $(CFLAGS) $(NARROW) $(CMOCKA_CFLAGS) -Itests -o $@ $(filter %.c,$^) $(ARCHIVES) $(CMOCKA_LIBS) -lm

# Public headers only, so no -Ilib.
$(BUILD)/tests/bench: tests/bench.c tests/bench_common.h $(ARCHIVES)
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(CPPFLAGS) $(filter-out -Ilib,$(STRICT)) $(POSIX) $(CFLAGS) -o $@ $< $(PROCEDURAL_A) $(CORE_A) -lm

# lib/scene/object.c with other names for what this program puts its own choice before.
$(BUILD)/tests/bench_robust: tests/bench_robust.c tests/bench_common.h $(ARCHIVES)
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)$(CC) $(CPPFLAGS) $(STRICT) $(CFLAGS) -Daset_object_nearest=robust_object_nearest -Daset_probe_make=robust_probe_make \
	  -c lib/scene/object.c -o $@_object.o
	$(Q)$(CC) $(CPPFLAGS) $(STRICT) $(POSIX) $(CFLAGS) -o $@ $< $@_object.o $(PROCEDURAL_A) $(CORE_A) -lm

# Embree 3, if a small program with it compiles and links; else bench_peers says that it is absent and ends well.
EMBREE = $(shell mkdir -p $(BUILD)/tests && echo 'int main(void) { return rtcNewDevice(0) == 0; }' | \
  $(CC) -include embree3/rtcore.h -x c - -o $(BUILD)/tests/embree-probe -lembree3 2>/dev/null && echo yes)
$(BUILD)/tests/bench_peers $(BUILD)/tests/bench_drafts: $(BUILD)/tests/%: tests/%.c tests/bench_common.h $(ARCHIVES)
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)if [ "$(EMBREE)" = yes ]; then with="-DBENCH_EMBREE=1" lib="-lembree3"; fi; \
	  $(CC) $(CPPFLAGS) $(STRICT) $(POSIX) $(CFLAGS) $$with -o $@ $< $(PROCEDURAL_A) $(CORE_A) $$lib -lm

# The same where no processor's wide registers are taken.
NARROW := -DASET_WIDE=0
$(BUILD)/tests/bench_drafts_narrow: tests/bench_drafts.c lib/approx/draft_beam.c lib/approx/draft_shadows.c tests/bench_common.h $(ARCHIVES)
	@mkdir -p $(@D)
	$(call say,CC)
	$(Q)if [ "$(EMBREE)" = yes ]; then with="-DBENCH_EMBREE=1" lib="-lembree3"; fi; \
	  $(CC) $(CPPFLAGS) $(STRICT) $(POSIX) $(CFLAGS) $(NARROW) "-DBENCH_BUILD=\"$(NARROW)\"" $$with -o $@ $(filter %.c,$^) $(PROCEDURAL_A) $(CORE_A) $$lib -lm

# Every program and script at once over the cores, each one's output in one piece, the long ones first. What has not ended well
# leaves its name in failed/. A make -jN is kept to.
JOBS ?= $(shell nproc 2>/dev/null || echo 2)
LONG_FIRST := tool.sh plan.sh test_tight test_baker models.sh
SCRIPTS := $(filter-out $(LONG_FIRST),faults.sh bake.sh determinism.sh)
CHECKS := check-layers check-link check-recursion check-readme check-man check-completion check-manifests
IN_TURN := $(LONG_FIRST) $(filter-out $(LONG_FIRST),$(TESTS)) $(SCRIPTS)
FAILED := $(BUILD)/failed
test: ## run the tests, in under two minutes
	@rm -rf $(FAILED) && mkdir -p $(FAILED)
	@$(MAKE) --no-print-directory -k -Otarget $(if $(findstring jobserver,$(MAKEFLAGS))$(filter -j%,$(MAKEFLAGS)),,-j$(JOBS)) test-each || touch $(FAILED)/make
	@failed=$$(ls $(FAILED)); if [ -n "$$failed" ]; then echo "failed:" $$failed; exit 1; fi; echo "all tests passed"

test-each: $(addprefix run-,$(IN_TURN) $(CHECKS)) all
# $(call each,NAME,COMMAND)
each = @echo "== $(1)"; mkdir -p $(FAILED); touch $(FAILED)/$(1); $(2) && rm $(FAILED)/$(1)
$(addprefix run-,$(TESTS)): run-%: $(BUILD)/tests/%
	$(call each,$*,$<)
run-tool.sh: $(BUILD)/aset
	$(call each,tool.sh,bash tests/tool.sh $<)
run-faults.sh: $(BUILD)/aset
	$(call each,faults.sh,bash tests/faults.sh $<)
run-models.sh: $(BUILD)/aset $(BUILD)/tests/convert
	$(call each,models.sh,bash tests/models.sh $^)
run-bake.sh: $(BUILD)/aset $(BUILD)/examples/flash
	$(call each,bake.sh,bash tests/bake.sh $^ "$(CC)")
run-determinism.sh: $(BUILD)/tests/determinism
	$(call each,determinism.sh,bash tests/determinism.sh quick $<)
run-plan.sh: $(BUILD)/aset
	$(call each,plan.sh,CPPFLAGS="$(CPPFLAGS)" bash tests/plan.sh $< "$(CC)")
$(addprefix run-,$(CHECKS)): run-%: %
.PHONY: test-each $(addprefix run-,$(TESTS) $(LONG_FIRST) $(SCRIPTS) $(CHECKS))

test-long: $(BUILD)/aset ## every method against brute force at 256 x 256 on the seven default scenes and snow (tens of minutes)
	bash tests/long.sh $(BUILD)/aset $(BUILD)/long

EXTREMES := test_tight test_self test_scale test_degenerate test_oracle test_arguments
check-extremes: $(addprefix $(BUILD)/tests/,$(EXTREMES)) ## geometry at its worst, with all the rays promised (minutes)
	@failed=; for t in $(EXTREMES); do echo "== $$t"; ASET_LONG=1 $(BUILD)/tests/$$t || failed="$$failed $$t"; done; \
	  if [ -n "$$failed" ]; then echo "failed:$$failed"; exit 1; fi

firmware-test: $(BUILD)/aset ## examples/firmware on a Cortex-M4 and a RISC-V under QEMU, against the host (MODEL=bunny.obj GRID=64: that draft)
	@GRID=$(GRID) bash tests/firmware.sh $(BUILD)/aset $(BUILD) "$(CC)" $(MODEL)

deps-firmware: ## install what firmware-test and size want: compilers for Arm and RISC-V, QEMU
	bash tools/deps-firmware.sh

determinism: $(BUILD)/aset ## golden hashes of pictures and counts, for every compiler and machine that can be built and run here
	bash tests/determinism.sh all $(BUILD)/aset $(BUILD)/determinism

fuzz: SECONDS ?= 60
fuzz: ## every reader, the draft, the scene and the tracer under a fuzzer, for SECONDS each (60); wants clang
	@CC="$(CC)" bash tests/fuzz.sh $(SECONDS) $(BUILD)/fuzz

test-sanitize: ## the tests once more with the address and undefined-behaviour sanitizers
	$(MAKE) BUILD=$(BUILD)/sanitize CFLAGS="-O1 -g -fsanitize=address,undefined -fno-sanitize-recover=all" test

coverage: ## branches of the core that the tests take (gcov); what none takes is named in tests/coverage.txt (minutes)
	@find $(BUILD)/coverage -name '*.gcda' -delete 2>/dev/null || true # counts of other sources do not add up
	-$(MAKE) BUILD=$(BUILD)/coverage CFLAGS="-O0 --coverage" test
	@bash tests/coverage.sh $(BUILD)/coverage

test-double: ## the tests once more in double precision
	$(MAKE) BUILD=$(BUILD)/double CPPFLAGS="-DASET_REAL_BITS=64" test

stack: ## the deepest stack of each public call, by gcc's call graph; no recursion
	@bash tests/stack.sh $(BUILD)/stack

lint: ## cppcheck and clang-tidy, clean but for what tests/lint/known.txt explains (minutes)
	@bash tests/lint.sh $(BUILD)/lint

check-long: ## both compilers, precisions, all sanitizers, valgrind, a hostile build, the extremes (hours; STEPS="fuzz memory")
	@bash tests/check-long.sh $(BUILD)/check-long $(STEPS)

check-layers: ## who includes whom, as DESIGN.md says
	@bash tests/layers.sh

check-link: $(CORE_A) ## the core's undefined symbols, and that other layout switches do not link
	@bash tests/link.sh $(BUILD) "$(CC)" "$(LIKE_THE_LIBRARY)"

check-recursion: ## no function of the core calls itself, directly or through others
	@bash tests/recursion.sh $(BUILD)

check-man: man ## the man pages against the help texts, the sources and the public headers
	@bash tests/man.sh $(BUILD)/aset $(BUILD)/man "$(CC)"

check-completion: $(BUILD)/aset.bash ## the completion for bash, called as bash would
	@bash tests/completion.sh $(BUILD)/aset $<

check-desktop: $(BUILD)/aset $(BUILD)/tests/convert ## the thumbnailer in a sandbox (bwrap), odd names, MIME types
	@bash tests/thumbnailer.sh $(BUILD)/aset $(BUILD)/tests/convert

check-examples: $(BUILD)/aset examples ## every example's pictures against golden ones
	@bash tests/examples.sh $(BUILD)/aset $(BUILD)/examples

check-cluster: $(BUILD)/aset $(BUILD)/tests/convert $(if $(shell command -v mpicc),$(BUILD)/cluster/mpi_render) ## many jobs and ranks draw one picture: the same bytes, troubles, times (a minute)
	@bash tests/cluster.sh $(BUILD)/aset $(BUILD)/tests/convert $(if $(shell command -v mpicc),$(BUILD)/cluster/mpi_render,-)

check-readme: $(ARCHIVES) ## the programs in README and docs compile and run, and the README's is examples/smallest.c
	@bash tests/docs.sh $(BUILD) "$(CC)" "$(LIKE_THE_LIBRARY)" quick

check-docs: $(BUILD)/aset $(BUILD)/tests/convert examples ## the same, and the commands that README and docs show
	@bash tests/docs.sh $(BUILD) "$(CC)" "$(LIKE_THE_LIBRARY)"

check-valgrind: $(BUILD)/aset examples ## the demo's programs under valgrind
	bash tests/valgrind.sh $(BUILD)

werror: ## everything without a single warning
	$(MAKE) BUILD=$(BUILD)/werror CFLAGS="-O2 -Werror" all $(addprefix $(BUILD)/werror/tests/,$(TESTS))

size: ## bytes of code by feature, for Cortex-M (make deps-firmware) and the host, into docs/size.md; an error above the limits
	@bash tools/size.sh "$(CC)" $(BUILD)/size docs/size.md

amalgamation: $(BUILD)/amalgamation/aset.c ## two files that hold the whole library: build/amalgamation/aset.c and aset.h
$(BUILD)/amalgamation/aset.c: tools/amalgamate.awk LICENSE $(wildcard include/aset/*.h lib/*/*.h) $(CORE) $(LOAD) $(PROCEDURAL)
	@mkdir -p $(@D)
	$(call say,AWK)
	$(Q)awk -f tools/amalgamate.awk -v out=$(@D) $(wordlist 2,$(words $^),$^)

arduino: amalgamation ## the same as a library for the Arduino IDE: the folder build/arduino/libaset
	@mkdir -p $(BUILD)/arduino/libaset/src
	$(Q)cp library.properties README.md LICENSE $(BUILD)/arduino/libaset
	$(Q)cp $(BUILD)/amalgamation/aset.[ch] $(BUILD)/arduino/libaset/src

check-manifests: ## versions and sources that other build systems are told; each public header alone in C99 and C++11
	@bash tests/manifests.sh $(BUILD) "$(CC)" "$(CXX)"

check-abi: $(SHARED) ## the shared library's interface against the last one written down (needs abidw and abidiff)
	@bash tests/abi.sh $(BUILD) $(ARGS)

consumers: amalgamation $(ARCHIVES) $(SHARED) $(BUILD)/aset $(BUILD)/examples/smallest ## other programs that take the library in, in every way of docs/linking.md
	@bash tests/consumers/run.sh $(BUILD) "$(CC)" "$(CXX)" $(ARGS)

# --- demo: pictures to look at ---

demo: $(BUILD)/aset $(addprefix $(BUILD)/examples/,$(EXAMPLES)) ## draw gears, tetra and snow, exact and approximate, into build/demo
	bash tools/demo.sh $(BUILD)/aset $(BUILD)/demo

hp9000: $(addprefix $(BUILD)/examples/,$(EXAMPLES)) ## draw the paper's figures within its bytes into build/hp9000
	@mkdir -p $(BUILD)/hp9000
	$(BUILD)/examples/hp9000_snow $(BUILD)/hp9000
	$(BUILD)/examples/hp9000_gears $(BUILD)/hp9000
	$(BUILD)/examples/hp9000_moon $(BUILD)/hp9000

methods: $(BUILD)/aset ## every method's draft of gears and snow in one sheet, and a table of all methods on all scenes
	bash tools/methods.sh $(BUILD)/aset $(BUILD)/methods

ladder: $(BUILD)/aset ## what a cell may remember, as pictures and as a table (ARGS="MODEL.obj ..." adds models; minutes)
	bash tools/ladder.sh $(BUILD)/aset $(BUILD)/ladder $(ARGS)

method-costs: $(BUILD)/aset ## what a step of each method costs, in instructions (needs valgrind): DESIGN.md's table
	@bash tools/costs.sh $(BUILD)/aset $(BUILD)/costs

bench: $(BUILD)/tests/bench ## build time and rays a second of every method (ARGS="--csv gears:3"; minutes)
	@$(BUILD)/tests/bench $(ARGS)

bench-instructions: $(BUILD)/tests/bench ## the same in instructions a ray (needs valgrind; ARGS="gears:3")
	@bash tests/bench-instructions.sh $(BUILD)/tests/bench $(BUILD)/bench-instructions $(ARGS)

bench-peers: $(BUILD)/tests/bench_peers ## ours beside Embree 3, if it is installed: build and picture, as ratios
	@$(BUILD)/tests/bench_peers $(ARGS)

bench-robust: $(BUILD)/tests/bench_robust ## what robust geometry costs: the library's tests beside plain ones, in turns
	@$(BUILD)/tests/bench_robust $(ARGS)

bench-drafts: $(BUILD)/tests/bench_drafts $(BUILD)/tests/bench_drafts_narrow ## from triangles to a picture: a draft beside Embree 3, at 262,144 and 4,194,304 triangles
	@$(BUILD)/tests/bench_drafts $(ARGS)
	@$(BUILD)/tests/bench_drafts_narrow $(ARGS)

plan-check: $(BUILD)/aset ## a plan's expectations against what happens, on the seven SPD scenes and three odd ones (minutes)
	bash tests/plan-check.sh $(BUILD)/aset $(BUILD)/plan-check

numerics: $(addprefix $(BUILD)/tests/,test_scale test_oracle bench_robust) ## the tables of docs/numerics.md: errors by place and object, costs
	bash tools/numerics.sh $(BUILD)/tests $(BUILD)/numerics docs/numerics.md

tables: $(BUILD)/aset ## the paper's Tables 1 to 4 beside ours, into docs/tables.md
	$(BUILD)/aset tables --markdown -o docs/tables.md

bench-walk: $(BUILD)/tests/bench_walk ## what the generic walk costs MSET against a hand-fused loop
	$(BUILD)/tests/bench_walk

prices: $(BUILD)/aset ## the README's price list: bytes, time, dB
	@bash tools/prices.sh $(BUILD)/aset $(BUILD)/prices

pictures: hp9000 ## draw docs/first.png and docs/snow.png anew (methods.png: make methods; drafts.png: make ladder)
	@bash tools/pictures.sh $(BUILD)/aset $(BUILD)/pictures docs/first.png
	cp $(BUILD)/hp9000/snow-30.png docs/snow.png

# --- installing ---

deps: ## install what is missing: compiler, make, pkg-config, libpng, cmocka
	bash tools/deps.sh

deps-cluster: ## install what examples/cluster needs: GNU parallel, Open MPI
	bash tools/deps.sh cluster

deps-consumers: ## install what make consumers and check-abi want besides: a C++ compiler, CMake, Meson, MinGW, abigail-tools
	bash tools/deps.sh consumers

# Written anew each time: it depends on PREFIX. The shared library has all that the archives have.
$(BUILD)/libaset.pc: FORCE
	@mkdir -p $(@D)
	@rm -f $@ # it may be another user's, who installed
	@printf '%s\n' 'prefix=$(PREFIX)' 'libdir=$(LIBDIR)' 'includedir=$${prefix}/include' '' 'Name: libaset' \
	  'Description: approximate ray tracing in a memory budget fixed at compile time' 'Version: $(VERSION)' \
	  'Libs: -L$${libdir} -laset' 'Libs.private: -laset_procedural -laset_load -laset -lm' 'Cflags: -I$${includedir}$(addprefix $() ,$(SWITCHES))' > $@

install: install-lib install-tool install-share ## install under DESTDIR/PREFIX; install-lib: all but the tool, for other switches (CPPFLAGS)
install-lib: $(ARCHIVES) $(SHARED) $(BUILD)/libaset.pc
	$(call one_word,PREFIX)$(call one_word,LIBDIR)$(if $(filter /%,$(PREFIX)),,$(error PREFIX=$(PREFIX): expected a path from the root, which pkg-config's file can say))
	install -d "$(DESTDIR)$(LIBDIR)/pkgconfig" "$(DESTDIR)$(PREFIX)/include/aset"
	install -m 644 include/aset/*.h "$(DESTDIR)$(PREFIX)/include/aset"
	install -m 644 $(ARCHIVES) "$(DESTDIR)$(LIBDIR)"
	install -m 755 $(SHARED) "$(DESTDIR)$(LIBDIR)"
	ln -sf libaset.so.$(VERSION) "$(DESTDIR)$(LIBDIR)/libaset.so.$(SOVERSION)"
	ln -sf libaset.so.$(SOVERSION) "$(DESTDIR)$(LIBDIR)/libaset.so"
	install -m 644 $(BUILD)/libaset.pc "$(DESTDIR)$(LIBDIR)/pkgconfig"
install-tool: $(BUILD)/aset
	$(call one_word,PREFIX)
	install -d "$(DESTDIR)$(PREFIX)/bin"
	install -m 755 $(BUILD)/aset "$(DESTDIR)$(PREFIX)/bin/aset"

INSTALLED = $(LIBDIR)/pkgconfig/libaset.pc $(addprefix $(LIBDIR)/,libaset.so libaset.so.$(SOVERSION) $(notdir $(SHARED) $(ARCHIVES))) \
  $(addprefix $(PREFIX)/,bin/aset $(wildcard include/aset/*.h) $(addprefix share/,man/man1/aset.1 man/man3/libaset.3 bash-completion/completions/aset \
  thumbnailers/aset.thumbnailer mime/packages/libaset.xml))
uninstall: ## remove what install has put there, with the same PREFIX, LIBDIR and DESTDIR
	$(call one_word,PREFIX)$(call one_word,LIBDIR)
	rm -f $(patsubst %,"$(DESTDIR)%",$(INSTALLED))
	-@rmdir "$(DESTDIR)$(PREFIX)/include/aset" 2> /dev/null
	@$(call update_mime)

# What a system has of a program beside the program: pages for man, words for the shell.
man: $(BUILD)/man/libaset.3 ## the man pages aset(1) and libaset(3), from the help texts and the headers
$(BUILD)/man/libaset.3: $(BUILD)/aset $(wildcard include/aset/*.h tools/*.awk) tools/man.sh
	$(call say,MAN)
	$(Q)bash tools/man.sh $(BUILD)/aset $(BUILD)/man

$(BUILD)/aset.bash: $(BUILD)/aset $(wildcard tools/*.awk) tools/completion.sh
	$(call say,BASH)
	$(Q)bash tools/completion.sh $(BUILD)/aset > $@.new && mv $@.new $@

SHARE = $(DESTDIR)$(PREFIX)/share
update_mime = [ -n "$(DESTDIR)" ] || ! command -v update-mime-database > /dev/null || ! [ -d "$(SHARE)/mime/packages" ] || update-mime-database "$(SHARE)/mime"
install-share: man $(BUILD)/aset.bash
	$(call one_word,PREFIX)
	for folder in man/man1 man/man3 bash-completion/completions thumbnailers mime/packages; do install -d "$(SHARE)/$$folder"; done
	install -m 644 $(BUILD)/man/aset.1 "$(SHARE)/man/man1"
	install -m 644 $(BUILD)/man/libaset.3 "$(SHARE)/man/man3"
	install -m 644 $(BUILD)/aset.bash "$(SHARE)/bash-completion/completions/aset"
	install -m 644 tools/desktop/aset.thumbnailer "$(SHARE)/thumbnailers"
	install -m 644 tools/desktop/libaset.xml "$(SHARE)/mime/packages"
	@$(update_mime)

clean: ## remove the build directory
	rm -rf $(BUILD)

help: ## show this text
	@sed -n 's/^\([a-z][a-z0-9-]*\):.*## \(.*\)/  \1|\2/p' Makefile | awk -F'|' '{ printf "  make %-16s %s\n", $$1, $$2 }' | sed 's/^  make   /  make /'

-include $(shell find $(BUILD) -name '*.d' 2>/dev/null)

.PHONY: install-lib install-tool uninstall arduino check-manifests check-abi deps-consumers amalgamation FORCE consumers numerics check-docs check-examples mpi check-cluster deps-cluster check-desktop man check-man check-completion install-share firmware-test deps-firmware bench-robust check-extremes check-long coverage lint stack determinism fuzz all examples test test-long test-sanitize test-double check-layers check-link check-recursion check-readme check-valgrind werror size demo \
  hp9000 methods ladder method-costs bench bench-instructions bench-peers bench-drafts bench-walk plan-check tables prices pictures deps install clean help
.SECONDARY:
