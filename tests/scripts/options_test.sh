#!/usr/bin/env bash
# What every script of scripts/ does with --help and with an option that it does not have: options_test.sh SOURCE_DIR. Nothing is
# done in either case.
set -euo pipefail

readonly source_dir=$1
work=$(mktemp -d)
readonly work
trap 'rm -rf -- "$work"' EXIT
export PYTHONDONTWRITEBYTECODE=1 CLEARWAY=/bin/false
cd -- "$work"
faults=0

# expect SCRIPT CODE WORDS ARGUMENT...: the script ends so and prints a line with the words.
expect() {
    local script=$1 wanted=$2 words=$3 code=0
    shift 3
    timeout 20 "$source_dir/scripts/$script" "$@" >"$work/said" 2>&1 </dev/null || code=$?
    if [[ $code != "$wanted" ]] || ! grep -qE -e "$words" "$work/said"; then
        printf 'FAILED: scripts/%s %s ends with %s instead of %s, or does not say <%s>:\n' "$script" "$*" "$code" "$wanted" "$words" >&2
        cat "$work/said" >&2
        faults=$((faults + 1))
    fi
}

tried=0
for path in "$source_dir"/scripts/*; do
    script=${path##*/}
    if [[ ! -x $path || $script == *.* ]]; then continue; fi
    tried=$((tried + 1))
    expect "$script" 0 "$script" --help
    if [[ $script != nightly ]]; then expect "$script" 2 "^usage:|--nonsense" --nonsense; fi  # nightly hands options on to ctest
done
expect check-format 2 'takes no path' src/policy
rm -f -- "$work/said"
if [[ -n $(ls -A "$work") ]]; then
    echo "FAILED: a script left files: $(ls -A "$work")" >&2
    faults=$((faults + 1))
fi
echo "$tried scripts"
exit $((faults > 0 || tried < 20))
