#!/usr/bin/env bash
# Tests of scripts/check-docs: docs_test.sh SOURCE_DIR CASE. Cases other than `pages_hold` write pages of their own into a
# temporary folder.
set -euo pipefail

readonly check=$1/scripts/check-docs source_dir=$1 case=$2
work=$(mktemp -d)
readonly work
trap 'rm -rf -- "$work"' EXIT

fail() {
    printf 'FAILED: %s\n' "$*" >&2
    if [[ -r $work/err ]]; then cat "$work/err" >&2; fi
    exit 1
}

# Runs the check on $work/tree: exit code in `code`, faults in $work/err.
run_check() {
    code=0
    "$check" "$work/tree" >/dev/null 2>"$work/err" || code=$?
}

expect_line() { grep -qF -- "$1" "$work/err" || fail "no line with <$1>"; }

pages_hold() { "$check" "$source_dir"; }

reports_each_fault() {
    mkdir -p "$work/tree/docs"
    printf '# A page\n\n[gone](docs/gone.md), [no heading](docs/b.md#not-there)\n' >"$work/tree/a.md"
    printf '# B\n\nThe EV drives.\n' >"$work/tree/docs/b.md"
    printf 'word %.0s' {1..601} >"$work/tree/README.md"
    run_check
    [[ $code == 1 ]] || fail "exit code $code"
    expect_line "a.md: link to docs/gone.md"
    expect_line "a.md: link to docs/b.md#not-there: no such heading"
    expect_line "docs/b.md: says EV before"
    expect_line "README.md: has more than 600 words"
}

accepts_good_pages() {
    mkdir -p "$work/tree/docs"
    printf '# A page\n\nAn emergency\nvehicle (EV), [two words](docs/b.md#two-words-1-s), <https://example.org>\n\n' >"$work/tree/a.md"
    printf '    [code](nowhere.md)\n\nText with `[code](nowhere.md)` and `EV`.\n' >>"$work/tree/a.md"
    printf '# B\n\n## Two words: 1 s\n\n[up](../a.md), [here](#two-words-1-s)\n' >"$work/tree/docs/b.md"
    run_check
    [[ $code == 0 ]] || fail "exit code $code"
}

declare -F -- "$case" >/dev/null || fail "no case $case"
"$case"
