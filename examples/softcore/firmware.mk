# What all targets share. A target's Makefile says its compiler, its start-up code and memory, and how to run.
#
#     make              builds the firmware and prints the program's trace
#     make check        compares the trace with the stored one
#     make timer        runs in real time, the timers driven by the timer interrupt
#     make build        only builds; the firmware is $(BUILD)/main.elf and $(BUILD)/timer.elf
#
#     make PROGRAM=../../interlocking18.rung      another program
#     make RUNG=../../../target/release/rung      a `rung` that is not in the path

RUNG ?= rung
PROGRAM ?= ../../traffic_light.rung
STIMULI ?= $(wildcard $(PROGRAM:.rung=.stimuli.csv))
TRACE ?= $(PROGRAM:.rung=.trace.csv)
CYCLE_MS ?= 100
# One folder for each program, so that what was built for one is never taken for another.
BUILD ?= build/$(basename $(notdir $(PROGRAM)))
OPT ?= -O2
WARNINGS ?= -Wall -Wextra -Wpedantic -Werror

override CFLAGS += $(OPT) -g -std=c99 $(WARNINGS) -ffp-contract=off -I.. -I$(BUILD)

ifneq ($(MEMORY),)
override LDFLAGS += -T $(MEMORY)
endif

# All of the firmware but its main loop.
PARTS ?= $(BUILD)/ladder.o $(BUILD)/tables.o $(BUILD)/trace.o
PORT_PARTS = $(addprefix $(BUILD)/,$(addsuffix .o,$(basename $(notdir $(PORT)))))

run: run-main

timer: run-timer

# Any firmware, by the name of its main loop.
run-%: $(BUILD)/%.elf
	@$(RUN) $<

check: $(BUILD)/main.elf
	$(RUN) $< > $(BUILD)/trace.csv
	cmp $(BUILD)/trace.csv $(TRACE)

build: $(BUILD)/main.elf $(BUILD)/timer.elf

clean:
	rm -rf build

.PHONY: run check timer build clean
.DELETE_ON_ERROR:
.SECONDARY:

# A new `rung` may make other code of the same program.
COMPILER := $(shell command -v $(RUNG))

# The program: an object straight from Rung where Rung makes code for the processor, or C.
ifneq ($(findstring --emit c,$(LADDER)),)
$(BUILD)/ladder.c $(BUILD)/ladder.h $(BUILD)/ladder.json &: $(PROGRAM) $(COMPILER) | $(BUILD)
	$(RUNG) build $< $(LADDER) -o $(BUILD)/ladder.c --header $(BUILD)/ladder.h --map $(BUILD)/ladder.json
else
$(BUILD)/ladder.o $(BUILD)/ladder.h $(BUILD)/ladder.json &: $(PROGRAM) $(COMPILER) | $(BUILD)
	$(RUNG) build $< $(LADDER) -o $(BUILD)/ladder.o --header $(BUILD)/ladder.h --map $(BUILD)/ladder.json
endif

$(BUILD)/tables.c: $(BUILD)/ladder.json $(STIMULI) ../tables.awk
	awk -v cycle_ms=$(CYCLE_MS) -f ../tables.awk $(BUILD)/ladder.json $(STIMULI) > $@

$(BUILD)/%.o: $(BUILD)/%.c
	$(CC) $(CFLAGS) -c -o $@ $<

$(BUILD)/%.o: ../%.c | $(BUILD)
	$(CC) $(CFLAGS) -c -o $@ $<

$(BUILD)/main.o $(BUILD)/timer.o: | $(BUILD)/ladder.json

define port_part
$(BUILD)/$(basename $(notdir $(1))).o: $(1) | $(BUILD)
	$(CC) $(CFLAGS) -c -o $$@ $$<
endef
$(foreach source,$(PORT),$(eval $(call port_part,$(source))))

$(BUILD)/%.elf: $(BUILD)/%.o $(PARTS) $(PORT_PARTS) $(MEMORY)
	$(CC) $(CFLAGS) $(LDFLAGS) -o $@ $(filter %.o,$^) $(LDLIBS)

$(BUILD):
	mkdir -p $@
