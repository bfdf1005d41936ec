#!/usr/bin/env bash
# scripts/check in a tree of its own, with checks that do as they are told: check_test.sh SOURCE_DIR
set -euo pipefail

readonly source_dir=$1
work=$(mktemp -d)
readonly work
trap 'rm -rf -- "$work"' EXIT
mkdir "$work/scripts"
cp -- "$source_dir/scripts/check" "$source_dir/scripts/script_help.sh" "$work/scripts"
readonly checks=(check-format check-docs render-docs count-docs count-house check-lists check-alone check-tidy)

# does NAME CODE: from now on the check says what it was called with, on many lines, and ends so.
does() {
    printf '#!/bin/sh\necho "%s $*"\nseq 20\nexit %s\n' "$1" "$2" >"$work/scripts/$1"
    chmod +x "$work/scripts/$1"
}

# expect CODE ARGUMENT...: scripts/check ends so.
expect() {
    local wanted=$1 code=0
    shift
    "$work/scripts/check" "$@" >"$work/said" 2>&1 || code=$?
    [[ $code == "$wanted" ]] || fail "scripts/check $* ends with $code instead of $wanted"
}

fail() {
    printf 'FAILED: %s:\n' "$1" >&2
    cat "$work/said" >&2
    exit 1
}

says() { grep -qE -e "$1" "$work/said" || fail "it does not say <$1>"; }
says_not() { ! grep -qE -e "$1" "$work/said" || fail "it says <$1>"; }

for name in "${checks[@]}"; do does "$name" 0; done
expect 0
for name in "${checks[@]}"; do says "^pass  $name +[0-9]+ s$"; done
says '^check: all passed$'
says_not '^ |FAIL'

# One that cannot be made fails nothing, and says why.
does check-lists 77
expect 0
says '^skip  check-lists +[0-9]+ s  20$'
does check-lists 0

does check-format 1
does check-tidy 3
expect 1
says '^FAIL  check-format '
says '^      check-format $'
says '^      11$'
says_not '^      12$'
says '^      \.\.\. 9 lines more: scripts/check-format says all$'
says '^      to do: scripts/check-format --fix$'
says '^      check-tidy --changed$'
says '^pass  check-alone '
says '^check: 2 failed$'

# A slow one tells how far it is while it runs; tail looks once a second.
printf '#!/bin/sh\necho "check-alone: 3 of 5" >&2\nsleep 2\n' >"$work/scripts/check-alone"
expect 1
says '^check-alone: 3 of 5$'
says '^pass  check-alone '
does check-alone 0

expect 1 --quick
says '^FAIL  check-format '
says_not 'check-tidy|check-alone'
does check-format 0
expect 0 --quick

# One that does not start is not one that passes.
rm -- "$work/scripts/count-docs"
expect 1 --quick
says '^FAIL  count-docs '

expect 2 src/policy
says 'takes no path'
expect 2 --quick src

# Pages that a built program makes: cat stands in for its list, a source that is newer for one that is not compiled.
mkdir -p "$work/docs/reference" "$work/src" "$work/programs/clearway" "$work/build/ci/bin"
cp -- "$source_dir/scripts/check-lists" "$work/scripts"
for page in settings columns scenario-keys; do echo "$page" >"$work/docs/reference/$page.md"; done
printf '#!/bin/sh\necho "$2"\n' >"$work/build/ci/bin/clearway"
chmod +x "$work/build/ci/bin/clearway"
touch -d '2 hours ago' "$work/src/a.cpp"
lists() {
    local code=0
    "$work/scripts/check-lists" >"$work/said" 2>&1 || code=$?
    [[ $code == "$1" ]] || fail "scripts/check-lists ends with $code instead of $1"
}
lists 0
echo old >"$work/docs/reference/columns.md"
lists 1
says '^docs/reference/columns.md is not what the sources say: build/ci/bin/clearway list columns --markdown > docs'
says_not 'settings'
touch -d '2 hours' "$work/src/a.cpp"
lists 77
says 'no built program is newer'
