BIN ?= .venv/bin

.PHONY: generate test lint check bench report

generate:
	$(BIN)/derive generate

test:
	$(BIN)/python -m pytest -q -n auto

lint:
	$(BIN)/ruff check
	$(BIN)/mypy

check:
	$(BIN)/derive generate --check
	$(BIN)/derive check

bench:
	$(BIN)/python -m bench

report:
	$(BIN)/python -m bench.report
	$(BIN)/python -m bench.pictures
