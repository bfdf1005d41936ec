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
    expect_line "README.md: has 601 words (allowed: 600; numbers, commands and comments count, too)"
}

refuses_pages_with_spoilt_text() {
    mkdir -p "$work/tree/docs/images"
    printf '# A\n\nnul \0\n' >"$work/tree/nul.md"
    printf '# A\n\nbell \a\n' >"$work/tree/bell.md"
    printf '# A\r\n' >"$work/tree/crlf.md"
    printf '\xef\xbb\xbf# A\n' >"$work/tree/mark.md"
    printf '# A\n\nleft to right \xe2\x80\xae\n' >"$work/tree/turned.md"
    printf '# A\n\nlatin \xfc\n' >"$work/tree/latin.md"
    printf '# A\n\nno end' >"$work/tree/cut.md"
    : >"$work/tree/empty.md"
    : >"$work/tree/docs/images/lonely.svg"
    run_check
    [[ $code == 1 ]] || fail "exit code $code"
    expect_line "nul.md:3: has an unprintable character"
    expect_line "bell.md:3: has an unprintable character"
    expect_line "crlf.md:1: has an unprintable character"
    expect_line "mark.md:1: has an unprintable character"
    expect_line "turned.md:3: has an unprintable character"
    expect_line "latin.md: is not UTF-8"
    expect_line "cut.md: does not end with a line feed"
    expect_line "empty.md: does not end with a line feed"
    expect_line "docs/images/lonely.svg: is on no page"
    grep -qF "check-docs: 9 faults" "$work/err" || fail "not nine faults"
}

refuses_a_folder_that_is_not_there() {
    run_check
    [[ $code == 1 ]] || fail "exit code $code"
    expect_line "tree is no folder"
}

accepts_good_pages() {
    mkdir -p "$work/tree/docs"
    printf '# A page\n\nAn emergency\nvehicle (EV), [two words](docs/b.md#two-words-1-s), <https://example.org>\n\n' >"$work/tree/a.md"
    printf '    [code](nowhere.md)\n\nText with `[code](nowhere.md)` and `EV`.\n' >>"$work/tree/a.md"
    mkdir -p "$work/tree/docs/images"
    : >"$work/tree/docs/images/shown.svg"
    printf '# B\n\n## Two words: 1 s\n\n[up](../a.md), [here](#two-words-1-s), caf\xc3\xa9\n' >"$work/tree/docs/b.md"
    printf '\n![A picture](images/shown.svg)\n' >>"$work/tree/docs/b.md"
    run_check
    [[ $code == 0 ]] || fail "exit code $code"
}

declare -F -- "$case" >/dev/null || fail "no case $case"
"$case"
