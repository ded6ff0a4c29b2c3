# People of the mannequin family as a scanner would give them, a mesh and nothing else, and measured: FIGURE.obj and FIGURE.body.json
# in OUT, the folder that a sample's Makefile sets.
BUILD ?= ../../build
BIN ?= $(BUILD)/tools
MAKERS ?= $(BUILD)/samples
.DEFAULT_GOAL := all
.DELETE_ON_ERROR:
.SUFFIXES:
.SECONDARY:
.PHONY: all clean

$(OUT):
	mkdir -p $@

$(OUT)/%.obj: | $(OUT)
	$(MAKERS)/make-mannequin --preset $* -o $@

$(OUT)/%.body.json: $(OUT)/%.obj
	$(BIN)/scan-landmarks -o $@ $<

clean:
	rm -rf $(OUT)
