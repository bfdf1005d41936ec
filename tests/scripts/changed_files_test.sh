#!/usr/bin/env bash
# Tests of scripts/check-alone, of scripts/check-tidy and of what they share: changed_files_test.sh SOURCE_DIR CASE. Each case
# has a repository of its own with two sources that are compiled as one unit, and remembers nothing of another.
set -euo pipefail

readonly source_dir=$1 case=$2
command -v git >/dev/null || {
    echo "skipped: git is not installed"
    exit 77
}
work=$(readlink -f -- "$(mktemp -d)")
readonly work tree=$work/tree
trap 'rm -rf -- "$work"' EXIT
export XDG_CACHE_HOME=$work/cache GIT_CONFIG_GLOBAL=/dev/null
unset CLEARWAY_BASE

fail() {
    printf 'FAILED: %s\n' "$*" >&2
    sed 's/^/said: /' "$work/said" >&2
    exit 1
}

# Runs check-alone; what it says goes to $work/said, its exit code to `code`.
check() {
    code=0
    "$tree/scripts/check-alone" "$@" >"$work/said" 2>&1 || code=$?
}

expect() {
    [[ $code == "$1" ]] || fail "expected exit code $1, got $code"
    grep -qE -- "$2" "$work/said" || fail "no line like <$2>"
}

commit() {
    git -C "$tree" add -A
    git -C "$tree" -c user.name=test -c user.email=test@invalid commit -qm "$1"
}

# `first` and `second` compile, by themselves and as one unit.
mkdir -p "$tree"/{scripts,src/part}
cp -- "$source_dir"/scripts/{check-alone,check-tidy,source_tree.py} "$tree/scripts/"
cat >"$tree/CMakePresets.json" <<'JSON'
{"version": 6, "configurePresets": [{"name": "dev", "generator": "Ninja", "binaryDir": "${sourceDir}/build/dev",
                                     "cacheVariables": {"CMAKE_EXPORT_COMPILE_COMMANDS": "ON"}}]}
JSON
cat >"$tree/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(tiny LANGUAGES CXX)
add_library(part STATIC src/part/first.cpp src/part/second.cpp)
target_include_directories(part PRIVATE src)
CMAKE
printf '#include "part/first.hpp"\nstd::string first() { return "1"; }\n' >"$tree/src/part/first.cpp"
printf '#pragma once\n#include <string>\nstd::string first();\n' >"$tree/src/part/first.hpp"
printf '#include <string>\n#include "part/alone.hpp"\nint second() { return alone("2"); }\n' >"$tree/src/part/second.cpp"
printf '#pragma once\n#include <string>\ninline int alone(const std::string& text) { return int(text.size()); }\n' >"$tree/src/part/alone.hpp"
printf '/build/\n__pycache__/\n' >"$tree/.gitignore"
git init -q "$tree"
commit 'it compiles'

# Behind `first` in one unit it would compile.
a_source_that_lacks_an_include_is_found() {
    check
    expect 0 '3 files, 0 known to be clean, 0 with findings'
    printf 'int second() { return int(std::string("2").size()); }\n' >"$tree/src/part/second.cpp"
    check
    expect 1 "second.cpp:1:.*error: 'string' is not a member|second.cpp:1:.*error: .string. is not a member"
}

# No source includes it first, so no source shows it.
a_header_that_lacks_an_include_is_found() {
    sed -i '/include <string>/d' "$tree/src/part/alone.hpp"
    commit 'a header that leans on what is before it'
    check --changed
    expect 1 'alone.hpp:2:.*string'
    expect 1 '0 sources, 1 headers that no source includes first'
}

only_what_differs_from_the_base_is_looked_at() {
    printf 'int second() { return int(std::string("2").size()); }\n' >"$tree/src/part/second.cpp"
    commit 'a source that does not compile'
    echo '// more' >>"$tree/src/part/first.hpp"
    commit 'another'
    check --changed
    expect 0 'check-alone: 1 files, 0 known'
    CLEARWAY_BASE=HEAD~2 check --changed
    expect 1 'check-alone: 2 files, 1 known to be clean, 1 with findings'
    CLEARWAY_BASE=HEAD check --changed
    expect 0 'check-alone: 0 files'
    CLEARWAY_BASE=nowhere check --changed
    expect 1 'CLEARWAY_BASE=nowhere is no commit of this repository'
}

# A branch that has not left origin/main is compared with itself while files differ.
what_is_not_committed_is_compared_with_this_commit() {
    echo '// more' >>"$tree/src/part/second.cpp"
    commit 'more'
    git -C "$tree" update-ref refs/remotes/origin/main HEAD
    echo '// more' >>"$tree/src/part/first.cpp"
    check --changed
    expect 0 'check-alone: 1 files'
}

what_was_clean_is_not_looked_at_again() {
    check
    check
    expect 0 '3 files, 3 known to be clean'
    echo '// more' >>"$tree/src/part/first.hpp"
    check
    expect 0 '3 files, 2 known to be clean'
}

all_changes_since_the_last_clean_commit_count() {
    check
    for word in one two; do
        echo "// $word" >>"$tree/src/part/first.cpp"
        commit "$word"
        echo "// $word" >>"$tree/README"
        commit "$word, not a source"
    done
    check --changed
    expect 0 'check-alone: 1 files, 0 known to be clean'
    commit_nothing=$(git -C "$tree" rev-parse HEAD)
    [[ $(<"$XDG_CACHE_HOME/clearway/clean-check-alone") == "$commit_nothing" ]] || fail 'the clean commit is not remembered'
}

# The same with check-tidy, which finds a null pointer that is written as 0.
tidy() {
    command -v clang-tidy-14 >/dev/null || {
        echo "skipped: clang-tidy-14 is not installed"
        exit 77
    }
    printf 'Checks: "-*,modernize-use-nullptr"\nWarningsAsErrors: "*"\nHeaderFilterRegex: "/src/"\n' >"$tree/.clang-tidy"
    code=0
    "$tree/scripts/check-tidy" "$@" >"$work/said" 2>&1 || code=$?
}
readonly finding='#pragma once\n#include <string>\ninline int* nothing() { return 0; }\n'

a_header_is_read_with_a_source_that_includes_it() {
    tidy src/part/alone.hpp
    expect 0 'check-tidy: 1 files'
    printf '%b' "$finding" 'inline int alone(const std::string& text) { return int(text.size()); }\n' >"$tree/src/part/alone.hpp"
    tidy src/part/alone.hpp
    expect 1 'alone.hpp:3:.*nullptr'
    tidy --changed src/part/alone.hpp
    expect 1 'alone.hpp:3:.*nullptr'
}

a_header_that_no_source_includes_is_read() {
    printf '%b' "$finding" >"$tree/src/part/third.hpp"
    tidy src/part/third.hpp
    expect 1 'third.hpp:3:.*nullptr'
    tidy --changed
    expect 1 'third.hpp:3:.*nullptr'
    sed -i 's/return 0/return nullptr/' "$tree/src/part/third.hpp"
    tidy src/part
    expect 0 'check-tidy: 3 files'
    tidy src/part/third.hpp
    expect 0 '1 files, 1 known to be clean'
}

a_path_that_is_not_there_is_refused() {
    check src/prat
    expect 2 'src/prat: no path that it looks at begins so'
    tidy src/part src/part/forth.hpp
    expect 2 'src/part/forth.hpp: no path that it looks at begins so'
}

[[ $(type -t "$case") == function ]] || fail "no such case: $case"
"$case"
