# The chain of one sample: scan, landmarks, pattern, panels, drape, picture. A sample's Makefile sets GARMENT and FIGURE, and may
# set DRAFT, options of make-pattern.
OUT ?= $(BUILD)/samples/$(GARMENT)
ACCURACY ?= draft
EDGE ?= 0.02
include ../people.mk

all: pictures

$(OUT)/$(GARMENT).pattern.json: $(OUT)/$(FIGURE).body.json
	$(MAKERS)/make-pattern $(GARMENT) $(DRAFT) --body $< -o $@

$(OUT)/panels.json: $(OUT)/$(GARMENT).pattern.json $(OUT)/$(FIGURE).body.json
	$(BIN)/pattern-mesh --edge-length $(EDGE) --body $(OUT)/$(FIGURE).body.json -o $@ $<

$(OUT)/$(GARMENT).json: $(OUT)/panels.json $(OUT)/$(FIGURE).body.json
	$(BIN)/drape --body $(OUT)/$(FIGURE).body.json --panels $< --accuracy $(ACCURACY) --report $(OUT)/report.json -o $@

VIEWS ?= front back
$(VIEWS:%=$(OUT)/%.png): $(OUT)/%.png: $(OUT)/$(GARMENT).json $(OUT)/$(FIGURE).body.json
	$(BIN)/render-png --view $* -o $@ $(OUT)/$(FIGURE).body.json $<

pictures: $(VIEWS:%=$(OUT)/%.png)

.PHONY: pictures
