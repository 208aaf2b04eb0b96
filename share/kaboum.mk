# Pattern rules for GNU make: bounding meshes, convex sets, pictures, and their verification. Include it,
# then ask for results by their names (docs/pipelines.md):
#
#     all: link.outer.stl.verified link.bcd.glb.verified arm.safe.verified
#     include /usr/share/kaboum/kaboum.mk
#
# NAME.outer.FORMAT    encloses the mesh NAME.EXTENSION
# NAME.inner.FORMAT    is enclosed by it
# NAME.bcd.FORMAT      convex bodies that cover it (glb or obj)
# RESULT.verified      report of bound-verify, made of the two files alone; only there if verified
# ROBOT.safe.verified  the same of ROBOT.safe/, a robot of convex bodies made of ROBOT.urdf
# RESULT.png           picture of a result, or of any mesh
#
# What was made with other values of the variables below is made anew. Values for single targets are set as
# in `link.outer.stl: KABOUM_EPSILON := 0.002`; changes of those are seen where the target depends on the
# Makefile.

# Largest distance: a length in the mesh's unit, or a percentage of its diagonal.
KABOUM_EPSILON ?= 1%
# More options of bmesh-decimate, of bcd-decompose and of bound-verify.
KABOUM_OUTER_FLAGS ?=
KABOUM_INNER_FLAGS ?=
KABOUM_BCD_FLAGS ?=
KABOUM_VERIFY_FLAGS ?= --prepare
# Of one program; make -j runs several. Results are the same for any number.
KABOUM_THREADS ?= 1
# Where the programs are, with a slash; empty: on PATH.
KABOUM_BIN ?=
# Extensions of meshes, in the order in which they are looked for, and formats of results.
KABOUM_INPUTS ?= stl STL obj OBJ ply off wrl dae 3mf x3d gltf glb fbx step stp iges igs
KABOUM_FORMATS ?= ply stl obj off glb
# Folder of what the rules note: dependencies and options.
KABOUM_NOTES ?= .kaboum.d

# What a program that failed has written is no result. All programs write whole files or none.
.DELETE_ON_ERROR:

_kaboum_common = --threads $(KABOUM_THREADS) --quiet
_kaboum_notes := $(shell mkdir -p '$(KABOUM_NOTES)')
_kaboum_depfile = --depfile '$(KABOUM_NOTES)/$(subst /,~,$@).d'

# $(call _kaboum_note,KIND,VALUES): a file that is newer than what was made with other values.
_kaboum_note = $(shell f='$(KABOUM_NOTES)/$(1).options'; v='$(subst ','"'"',$(2))'; \
  [ -f "$$f" ] && [ "$$(cat "$$f")" = "$$v" ] || { printf '%s\n' "$$v" >"$$f.$$$$" && mv -f "$$f.$$$$" "$$f"; })
_kaboum_notes := $(call _kaboum_note,outer,$(KABOUM_EPSILON) $(KABOUM_OUTER_FLAGS))
_kaboum_notes := $(call _kaboum_note,inner,$(KABOUM_EPSILON) $(KABOUM_INNER_FLAGS))
_kaboum_notes := $(call _kaboum_note,bcd,$(KABOUM_EPSILON) $(KABOUM_BCD_FLAGS))
_kaboum_notes := $(call _kaboum_note,verify,$(KABOUM_EPSILON) $(KABOUM_VERIFY_FLAGS))

# After the notes are written: make remembers what is in a folder from its first look on.
-include $(wildcard $(KABOUM_NOTES)/*.d)

# A report is renamed when the verdict is known: one of a verifier that was ended is none.
_kaboum_verify = rm -f '$@'; $(KABOUM_BIN)bound-verify $(1) --epsilon '$(KABOUM_EPSILON)' $(KABOUM_VERIFY_FLAGS) \
  $(_kaboum_common) --report '$@.part' && mv -f '$@.part' '$@'

# $(call _kaboum_rules,EXTENSION,FORMAT)
define _kaboum_rules
%.outer.$(2): %.$(1) $(KABOUM_NOTES)/outer.options
	$$(KABOUM_BIN)bmesh-decimate '$$<' -o '$$@' --epsilon '$$(KABOUM_EPSILON)' $$(KABOUM_OUTER_FLAGS) $$(_kaboum_common) $$(_kaboum_depfile)
%.inner.$(2): %.$(1) $(KABOUM_NOTES)/inner.options
	$$(KABOUM_BIN)bmesh-decimate '$$<' -o '$$@' --direction inner --epsilon '$$(KABOUM_EPSILON)' $$(KABOUM_INNER_FLAGS) $$(_kaboum_common) $$(_kaboum_depfile)
%.outer.$(2).verified: %.$(1) %.outer.$(2) $(KABOUM_NOTES)/verify.options
	$$(call _kaboum_verify,mesh --outer '$$<' '$$(word 2,$$^)')
%.inner.$(2).verified: %.$(1) %.inner.$(2) $(KABOUM_NOTES)/verify.options
	$$(call _kaboum_verify,mesh --inner '$$<' '$$(word 2,$$^)')
endef
define _kaboum_set_rules
%.bcd.$(2): %.$(1) $(KABOUM_NOTES)/bcd.options
	$$(KABOUM_BIN)bcd-decompose '$$<' -o '$$@' --epsilon '$$(KABOUM_EPSILON)' $$(KABOUM_BCD_FLAGS) $$(_kaboum_common) $$(_kaboum_depfile)
%.bcd.$(2).verified: %.$(1) %.bcd.$(2) $(KABOUM_NOTES)/verify.options
	$$(call _kaboum_verify,cover '$$<' '$$(word 2,$$^)')
endef
$(foreach i,$(KABOUM_INPUTS),$(foreach f,$(KABOUM_FORMATS),$(eval $(call _kaboum_rules,$(i),$(f)))))
$(foreach i,$(KABOUM_INPUTS),$(foreach f,glb obj,$(eval $(call _kaboum_set_rules,$(i),$(f)))))

%.safe.verified: %.urdf $(KABOUM_NOTES)/bcd.options $(KABOUM_NOTES)/verify.options
	$(KABOUM_BIN)bcd-decompose '$<' -o '$*.safe' --epsilon '$(KABOUM_EPSILON)' $(KABOUM_BCD_FLAGS) $(_kaboum_common) --depfile '$@.part'
	sed 's|^$*\.safe/[^:]*:|$@:|' '$@.part' >'$(KABOUM_NOTES)/$(subst /,~,$@).d' && rm -f '$@.part'
	$(call _kaboum_verify,robot '$<' '$*.safe/$(<F)')

%.png: %
	$(KABOUM_BIN)mesh-picture '$<' -o '$@'

# Results that only lead to others are kept.
.SECONDARY:
