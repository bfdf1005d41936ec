#!/usr/bin/env bash
# Manual pages and completion: help_test.sh SOURCE_DIR CLEARWAY
set -euo pipefail

readonly source_dir=$1 program=$2
work=$(mktemp -d)
readonly work
trap 'rm -rf -- "$work"' EXIT

fail() {
    printf 'FAILED: %s\n' "$*" >&2
    exit 1
}

# The completions of a command line, whose last word is being typed.
completed() {
    COMP_WORDS=("$@")
    COMP_CWORD=$(($# - 1))
    COMPREPLY=()
    _clearway
    printf '%s' "${COMPREPLY[*]}"
}

expect_completion() {
    local wanted=$1 got
    shift
    got=$(completed "$@")
    [[ $got == "$wanted" ]] || fail "\`$*\` is completed to <$got>, not <$wanted>"
}

"$source_dir/scripts/render-help" "$program" "$work"
# shellcheck source=/dev/null
source "$work/bash-completion/completions/clearway"
expect_completion study clearway stu
expect_completion 'status submit' clearway study s
expect_completion --policy clearway run city --pol
expect_completion corridor clearway run city --policy corr
expect_completion 'city city_accident city_v2' clearway run cit
expect_completion 'on off' clearway run city --safety-checks o
expect_completion '' clearway run city --out ''
expect_completion --json clearway study status --js

# Each option that a help text shows stands in the manual and in both completions.
for verb in run 'study submit' live 'links evaluate'; do
    read -ra words <<<"$verb"
    page=$work/man/man1/clearway-${verb// /-}.1
    while read -r option; do
        grep -qF -- "${option//-/\\-}" "$page" || fail "${page##*/} lacks $option"
        [[ " ${_clearway_options["clearway $verb"]} " == *" $option "* ]] || fail "bash does not complete $verb $option"
        [[ $(sed -n "/^    ('clearway $verb')/,/;;/p" "$work/zsh/vendor-completions/_clearway") == *"$option["* ]] ||
            fail "zsh does not complete $verb $option"
    done < <(SUMO_HOME=/usr/share/sumo "$program" "${words[@]}" --help | grep -oE '^  --[a-z-]+' | tr -d ' ')
done

printf '#!/bin/sh\n[ "$1" = --help ] && printf "A program\\nUsage: x\\n\\nOptions:\\n      odd\\n"\n' >"$work/odd"
chmod +x "$work/odd"
! "$source_dir/scripts/render-help" "$work/odd" "$work/no" 2>"$work/err" || fail 'a help text of another form is taken'
grep -q "neither a term, its text nor prose: '      odd'" "$work/err" || fail 'its message'
