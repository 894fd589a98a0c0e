# The firmware: the library and its example for bare Cortex-M processors, run in an emulator and compared with the host.

# prefix of the cross compiler for Cortex-M
ARM_PREFIX ?= arm-none-eabi-
# emulator of Arm boards
QEMU_ARM ?= qemu-system-arm

# A variant: processor, FPU, the type of ast_real, emulated board. The processors with a single-precision FPU compute in float
# alone.
# m7-tiny is for patches alone, as the tiny preset has them: without the gradients' code.
firmware_variants := m7-double m7-single m7-tiny m4-single
m7-double_cpu := -mcpu=cortex-m7 -mfpu=fpv5-d16
m7-double_real := double
m7-double_board := mps2-an500
m7-single_cpu := -mcpu=cortex-m7 -mfpu=fpv5-sp-d16
m7-single_real := float
m7-single_board := mps2-an500
m7-tiny_cpu := $(m7-single_cpu) -DAST_NO_GRADIENT
m7-tiny_real := float
m7-tiny_board := mps2-an500
m4-single_cpu := -mcpu=cortex-m4 -mfpu=fpv4-sp-d16
m4-single_real := float
m4-single_board := mps2-an386

firmware_dir := $(BUILDDIR)/firmware
firmware_lib_sources := $(core_sources) src/linalg_builtin.c
firmware_flags = -std=c99 -ffp-contract=off -fno-math-errno $(filter-out -Werror,$(warnings)) -Werror -Wdouble-promotion -Iinclude \
	-MMD -MP -DAST_NO_HEAP -DAST_NO_LITERAL -DAST_LANES=4
firmware_target_flags = -Os -g -mthumb -mfloat-abi=hard -ffunction-sections -fdata-sections
firmware_program := program say camera small_scene
firmware_images := $(firmware_variants:%=$(firmware_dir)/%/program.elf)
firmware_hosts := $(firmware_dir)/host-float/program $(firmware_dir)/host-double/program $(firmware_dir)/host-minutes/program

.PHONY: firmware test-firmware
firmware: $(firmware_images) ## the Cortex-M images, without operating system and heap
	@$(ARM_PREFIX)size $(firmware_images)

$(firmware_dir)/flags: export recorded = $(ARM_PREFIX) $(CC) $(firmware_flags) $(firmware_target_flags)
$(firmware_dir)/flags: FORCE
	@mkdir -p $(@D)
	@printf '%s\n' "$$recorded" | cmp -s - $@ || printf '%s\n' "$$recorded" > $@

# $(call firmware_rules,directory,compiler and its flags,type of ast_real)
define firmware_rules
$(firmware_dir)/$(1)/lib/%.o: src/%.c $(firmware_dir)/flags
	@mkdir -p $$(@D)
	$$(call say,CC)
	$$(quiet)$(2) $$(firmware_flags) -DAST_REAL=$(3) -c -o $$@ $$<
$(firmware_dir)/$(1)/example/%.o: examples/cortex-m7/%.c $(firmware_dir)/flags
	@mkdir -p $$(@D)
	$$(call say,CC)
	$$(quiet)$(2) $$(firmware_flags) -DAST_REAL=$(3) -c -o $$@ $$<
endef
$(foreach v,$(firmware_variants),$(eval $(call firmware_rules,$(v),$(ARM_PREFIX)gcc $(firmware_target_flags) $($(v)_cpu),$($(v)_real))))
$(foreach r,float double,$(eval $(call firmware_rules,host-$(r),$(CC) -O2 -D_DEFAULT_SOURCE,$(r))))

# The same with faults of two minutes, at 30 frames a second.
$(eval $(call firmware_rules,host-minutes,$(CC) -O2 -D_DEFAULT_SOURCE -DFRAMES_OF_FAULT=3600,float))

firmware_objects = $(firmware_lib_sources:src/%.c=$(firmware_dir)/$(1)/lib/%.o) $(patsubst %,$(firmware_dir)/$(1)/example/%.o,$(2))

# Only memcpy, memset, memcmp and what the compiler itself calls come from outside: newlib and libgcc.
.SECONDEXPANSION:
$(firmware_images): $(firmware_dir)/%/program.elf: $$(call firmware_objects,$$*,$(firmware_program) board_mps2) examples/cortex-m7/mps2.ld
	$(call say,LINK)
	$(quiet)$(ARM_PREFIX)gcc -mthumb -mfloat-abi=hard $($*_cpu) -nostartfiles -T examples/cortex-m7/mps2.ld -Wl,--gc-sections \
	    -Wl,--fatal-warnings -o $@ $(filter %.o,$^)
$(firmware_hosts): $(firmware_dir)/host-%/program: $$(call firmware_objects,host-$$*,$(firmware_program) board_host)
	$(call say,LINK)
	$(quiet)$(CC) -o $@ $^

# Instructions, counted by the emulator; it has room for what a microcontroller's RAM has not.
firmware_counters := $(firmware_dir)/m7-single/instructions.elf $(firmware_dir)/m4-single/instructions.elf
$(firmware_counters): $(firmware_dir)/%/instructions.elf: $$(call firmware_objects,$$*,instructions say small_scene board_mps2) examples/cortex-m7/mps2.ld
	$(call say,LINK)
	$(quiet)$(ARM_PREFIX)gcc -mthumb -mfloat-abi=hard $($*_cpu) -nostartfiles -T examples/cortex-m7/mps2.ld -Wl,--gc-sections \
	    -Wl,--fatal-warnings -Wl,--defsym=ram_size=4M -o $@ $(filter %.o,$^)
.PHONY: instructions-firmware
instructions-firmware: $(firmware_counters) ## instructions a frame on a Cortex-M7 and a Cortex-M4F, counted by the emulator
	@$(foreach v,m7-single m4-single,echo "$(v):" && timeout 500 $(QEMU_ARM) -M $($(v)_board) -icount shift=0 -nographic -monitor none \
	    -serial none -semihosting-config enable=on,target=native -kernel $(firmware_dir)/$(v)/instructions.elf &&) true

test-firmware: $(firmware_images) $(firmware_hosts) ## run the images in the emulator and compare with the host, bit for bit
	@ARM_PREFIX=$(ARM_PREFIX) QEMU_ARM=$(QEMU_ARM) scripts/test_firmware.sh $(firmware_dir) \
	    $(foreach v,$(firmware_variants),$(v):$($(v)_real):$($(v)_board))

-include $(wildcard $(firmware_dir)/*/*/*.d)

# ---- Budgets for a Cortex-M7 with a single-precision FPU, -Os ----

# most stack that a call into the library may take there, bytes
FIRMWARE_STACK ?= 4096
# most code and constants without save and restore and diagnostics, bytes
FIRMWARE_CODE ?= 32768

# What a program that tracks calls. What it does not (save and restore, looking inside, texts, the geometry alone, conversion of
# colours) the linker leaves out.
firmware_calls := ast_config_preset ast_mem_size ast_init ast_start ast_step ast_free
firmware_lib_objects = $(call firmware_objects,m7-single,)
firmware_tiny_objects = $(call firmware_objects,m7-tiny,)

.PHONY: size-firmware stack-firmware link-firmware test-cross test-cross-short
# $(call firmware_core,objects,file): what a program that tracks has of them
firmware_core = $(ARM_PREFIX)ld --gc-sections --unresolved-symbols=ignore-all -e ast_step $(firmware_calls:%=-u %) -o $(2) $(1)
size-firmware: $(firmware_lib_objects) $(firmware_tiny_objects) ## code and constants on a Cortex-M7; fails above FIRMWARE_CODE
	@$(call firmware_core,$(firmware_lib_objects),$(firmware_dir)/core.elf)
	@$(call firmware_core,$(firmware_tiny_objects),$(firmware_dir)/tiny.elf)
	@$(ARM_PREFIX)size $(firmware_lib_objects) $(firmware_dir)/core.elf $(firmware_dir)/tiny.elf | awk -v most=$(FIRMWARE_CODE) 'NR > 1 { \
	    if ($$6 ~ /core[.]elf$$/) core = $$1; else if ($$6 ~ /tiny[.]elf$$/) tiny = $$1; else { all += $$1; data += $$2 + $$3 } } \
	    END { printf "Cortex-M7, -Os: code and constants %d bytes, without save, restore and diagnostics %d, and without gradients " \
	    "%d (at most %d), data %d\n", all, core, tiny, most, data; exit core == 0 || tiny == 0 || tiny > most || data > 0 }'

stack-firmware: ## the same for the stack; fails above FIRMWARE_STACK
	+@$(MAKE) --no-print-directory BUILDDIR=$(BUILDDIR)/stack-m7 CC=$(ARM_PREFIX)gcc OBJDUMP=$(ARM_PREFIX)objdump BACKEND=builtin \
	    LAPACKE=no JPEG=no CPPFLAGS='-DAST_REAL=float -DAST_NO_HEAP -DAST_LANES=4' STACK_CEILING=$(FIRMWARE_STACK) CFLAGS='-Os -mthumb \
	    -mfloat-abi=hard $(m7-single_cpu) -ffunction-sections -fno-jump-tables -fcallgraph-info=su' stack-objects

# The library on its own, without any C library: nothing but these may be missing.
link-firmware: $(firmware_lib_objects) ## fails when the library needs more of a C library than memcpy, memset and memcmp
	@missing=$$($(ARM_PREFIX)ld -r -o $(firmware_dir)/whole.o $(firmware_lib_objects) && $(ARM_PREFIX)nm -u $(firmware_dir)/whole.o | \
	    awk '{ print $$2 }' | grep -v -x -E 'memcpy|memset|memcmp' | paste -s -d ' '); \
	if [ -n "$$missing" ]; then echo "needed from outside: $$missing" >&2; exit 1; fi; echo "needs memcpy, memset and memcmp, nothing else"

test-cross: unity ## the same bits on every processor, by gcc and clang, -O0 to -O3, and the C tests there
	+@scripts/test_cross.sh $(BUILDDIR)/cross whole
test-cross-short: unity ## the same by gcc, -O3, and some of the C tests
	+@scripts/test_cross.sh $(BUILDDIR)/cross short
