# The chain of one sample: scan, landmarks, pattern, panels, drape, picture. A sample's Makefile sets GARMENT and FIGURE.
BUILD ?= ../../build
BIN ?= $(BUILD)/tools
OUT ?= $(BUILD)/samples/$(GARMENT)
MAKERS ?= $(BUILD)/samples
ACCURACY ?= draft
EDGE ?= 0.02
.DELETE_ON_ERROR:
.SUFFIXES:

all: pictures

$(OUT):
	mkdir -p $@

# A figure of the mannequin family, as a scanner would give it: a mesh and nothing else.
$(OUT)/%.obj: | $(OUT)
	$(MAKERS)/make-mannequin --preset $* -o $@

$(OUT)/%.body.json: $(OUT)/%.obj
	$(BIN)/scan-landmarks -o $@ $<

$(OUT)/$(GARMENT).pattern.json: $(OUT)/$(FIGURE).body.json
	$(MAKERS)/make-pattern $(GARMENT) --body $< -o $@

$(OUT)/panels.json: $(OUT)/$(GARMENT).pattern.json $(OUT)/$(FIGURE).body.json
	$(BIN)/pattern-mesh --edge-length $(EDGE) --body $(OUT)/$(FIGURE).body.json -o $@ $<

$(OUT)/$(GARMENT).json: $(OUT)/panels.json $(OUT)/$(FIGURE).body.json
	$(BIN)/drape --body $(OUT)/$(FIGURE).body.json --panels $< --accuracy $(ACCURACY) --report $(OUT)/report.json -o $@

VIEWS ?= front back
$(VIEWS:%=$(OUT)/%.png): $(OUT)/%.png: $(OUT)/$(GARMENT).json $(OUT)/$(FIGURE).body.json
	$(BIN)/render-png --view $* -o $@ $(OUT)/$(FIGURE).body.json $<

clean:
	rm -rf $(OUT)

pictures: $(VIEWS:%=$(OUT)/%.png)

.PHONY: all pictures clean
.SECONDARY:
