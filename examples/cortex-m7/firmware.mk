# The firmware: the library and its example for bare Cortex-M processors, run in an emulator and compared with the host.

# prefix of the cross compiler for Cortex-M
ARM_PREFIX ?= arm-none-eabi-
# emulator of Arm boards
QEMU_ARM ?= qemu-system-arm

# A variant: processor, FPU, the type of ast_real, emulated board. The processors with a single-precision FPU compute in float alone.
firmware_variants := m7-double m7-single m4-single
m7-double_cpu := -mcpu=cortex-m7 -mfpu=fpv5-d16
m7-double_real := double
m7-double_board := mps2-an500
m7-single_cpu := -mcpu=cortex-m7 -mfpu=fpv5-sp-d16
m7-single_real := float
m7-single_board := mps2-an500
m4-single_cpu := -mcpu=cortex-m4 -mfpu=fpv4-sp-d16
m4-single_real := float
m4-single_board := mps2-an386

firmware_dir := $(BUILDDIR)/firmware
firmware_lib_sources := $(core_sources) src/linalg_builtin.c
firmware_flags = -std=c99 -ffp-contract=off -fno-math-errno $(filter-out -Werror,$(warnings)) -Werror -Wdouble-promotion -Iinclude \
	-MMD -MP -DAST_NO_HEAP
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

test-firmware: $(firmware_images) $(firmware_hosts) ## run the images in the emulator and compare with the host, bit for bit
	@ARM_PREFIX=$(ARM_PREFIX) QEMU_ARM=$(QEMU_ARM) scripts/test_firmware.sh $(firmware_dir) \
	    $(foreach v,$(firmware_variants),$(v):$($(v)_real):$($(v)_board))

-include $(wildcard $(firmware_dir)/*/*/*.d)
