#!/usr/bin/env bash
# Tests of the launcher: launcher_test.sh SOURCE_DIR CASE. Each case gets a tree of its own in a temporary folder: the real
# launcher and set-up script around a project that is built by copying a shell script, with stand-ins for dpkg-query,
# apt-get and id on PATH. cmake, ninja and ctest are the real ones.
set -euo pipefail

readonly source_dir=$1 case=$2
work=$(readlink -f -- "$(mktemp -d)")
readonly work
trap 'rm -rf -- "$work"' EXIT
unset CMAKE_BUILD_PARALLEL_LEVEL SUMO_HOME
export CCACHE_DISABLE=1

fail() {
    printf 'FAILED: %s\n' "$*" >&2
    for file in "$work"/out "$work"/err; do
        [[ -r $file ]] && sed "s|^|${file##*/}: |" "$file" >&2
    done
    exit 1
}

expect_equal() { [[ $1 == "$2" ]] || fail "expected <$2>, got <$1>${3:+ ($3)}"; }
expect_line() { grep -qE -- "$2" "$1" || fail "no line like <$2> in ${1##*/}"; }
expect_no_line() { ! grep -qE -- "$2" "$1" || fail "a line like <$2> in ${1##*/}"; }
expect_builds() { expect_equal "$(wc -l <"$tree/builds" 2>/dev/null || echo 0)" "$1" "number of builds: ${2:-}"; }

# Runs a command; its streams go to $work/out and $work/err, its exit code to `code`.
run() {
    code=0
    "$@" >"$work/out" 2>"$work/err" || code=$?
}

# Makes a project tree in $1. Its program prints its arguments, folder and SUMO_HOME, copies its input and exits with
# the code in argument 1; every build of it appends a line to TREE/builds.
make_tree() {
    tree=$1
    mkdir -p "$tree"/{scripts,packaging,programs,src,.ci}
    cp -- "$source_dir"/{clearway,test,.clang-format} "$tree/"
    cp -- "$source_dir"/scripts/{setup.sh,check-format,check-skips,script_help.sh} "$tree/scripts/"
    cp -- "$source_dir/.ci/run" "$tree/.ci/"
    printf '%s\n' '# a comment' '' 'alpha run who' 'beta  run who' 'gamma test who' 'delta train who' 'omega extra who' \
        >"$tree/packaging/packages.txt"
    cat >"$tree/CMakePresets.json" <<'JSON'
{"version": 6,
 "configurePresets": [
   {"name": "release", "generator": "Ninja", "binaryDir": "${sourceDir}/build/${presetName}"},
   {"name": "ci", "inherits": "release"}, {"name": "dev", "inherits": "release"}, {"name": "asan", "inherits": "release"},
   {"name": "tsan", "inherits": "release"}],
 "testPresets": [{"name": "asan", "configurePreset": "asan"}, {"name": "tsan", "configurePreset": "tsan"}]}
JSON
    cat >"$tree/CMakeLists.txt" <<'CMAKE'
cmake_minimum_required(VERSION 3.25)
project(tiny LANGUAGES NONE)
enable_testing()
add_test(NAME verdict COMMAND sh ${CMAKE_SOURCE_DIR}/src/verdict.sh)
file(GLOB parts CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/*.part)
add_custom_command(OUTPUT bin/clearway DEPENDS src/build.sh src/program.sh ${parts}
                   COMMAND sh ${CMAKE_SOURCE_DIR}/src/build.sh ${CMAKE_SOURCE_DIR} ${CMAKE_BINARY_DIR}/bin VERBATIM)
add_custom_target(tiny ALL DEPENDS bin/clearway)
if(CLEARWAY_TRAINING)
    add_custom_command(OUTPUT bin/clearway-train DEPENDS src/trainer.sh
                       COMMAND cp ${CMAKE_SOURCE_DIR}/src/trainer.sh bin/clearway-train VERBATIM)
    add_custom_target(trainer ALL DEPENDS tiny bin/clearway-train)
endif()
install(PROGRAMS ${CMAKE_BINARY_DIR}/bin/clearway DESTINATION bin)
foreach(label fast threads)
    add_custom_target(tests_${label} COMMAND echo built >>${CMAKE_SOURCE_DIR}/built_${label})
endforeach()
CMAKE
    cat >"$tree/src/build.sh" <<'SH'
set -e
mkdir -p "$2"
cp "$1/src/program.sh" "$2/clearway"
echo built >>"$1/builds"
SH
    cat >"$tree/src/program.sh" <<'SH'
#!/bin/sh
echo "arguments:$(printf ' <%s>' "$@")"
echo "folder: $PWD"
echo "SUMO_HOME: $SUMO_HOME"
exit "${1:-0}"
SH
    chmod +x "$tree/src/program.sh"
    printf '#!/bin/sh\n' >"$tree/src/trainer.sh"
    chmod +x "$tree/src/trainer.sh"
    echo 'exit 0' >"$tree/src/verdict.sh"
    fake_machine
}

# Checks that `./test --full` calls: each prints its name and arguments and ends with what $work/NAME.code holds.
fake_checks() {
    local name
    for name in check-tidy check-alone bare-machine; do
        printf '#!/bin/sh\necho "%s $1"\nexit "$(cat "%s" 2>/dev/null || echo 0)"\n' "$name" "$work/$name.code" >"$tree/scripts/$name"
        chmod +x "$tree/scripts/$name"
    done
}

# Puts the stand-ins on PATH: what is installed stands in $work/installed (`name version` lines), the user id in $work/uid.
fake_machine() {
    mkdir -p "$work/fake"
    printf '%s\n' 'alpha 1' 'beta 1' 'gamma 1' >"$work/installed"
    echo 1000 >"$work/uid"
    : >"$work/apt"
    cat >"$work/fake/dpkg-query" <<SH
#!/bin/sh
while read -r name version; do
    for asked in "\$@"; do [ "\$asked" = "\$name" ] && echo "\$name installed \$version"; done
done <"$work/installed"
exit 1
SH
    cat >"$work/fake/id" <<SH
#!/bin/sh
cat "$work/uid"
SH
    cat >"$work/fake/apt-get" <<SH
#!/bin/sh
echo "\$DEBIAN_FRONTEND \$*" >>"$work/apt"
[ ! -e "$work/apt_fails" ] || exit 100
case " \$* " in *' install '*) for name in "\$@"; do case \$name in
    alpha|beta|gamma|delta|omega) echo "\$name 1" >>"$work/installed" ;;
esac; done ;; esac
echo "text of apt-get"
SH
    chmod +x "$work"/fake/*
    PATH=$work/fake:$PATH
}

# Median wall time of five runs of a command, in ms.
median_ms() {
    local start
    for _ in 1 2 3 4 5; do
        start=${EPOCHREALTIME/./}
        "$@" >/dev/null
        echo $(((${EPOCHREALTIME/./} - start) / 1000))
    done | sort -n | sed -n 3p
}

# The real package list, the real dpkg-query and all of the project's sources, so that the time is the real one.
adds_little_when_all_is_in_place() {
    make_tree "$work/tree"
    rm "$work"/fake/*
    cp -- "$source_dir/packaging/packages.txt" "$tree/packaging/"
    cp -r -- "$source_dir"/src/*/ "$tree/src/"
    cp -r -- "$source_dir"/cmake "$tree/"
    run "$tree/clearway"
    expect_equal "$code" 0
    local with without
    with=$(median_ms "$tree/clearway")
    without=$(median_ms "$tree/build/release/bin/clearway")
    echo "the launcher adds $((with - without)) ms"
    ((with - without < 300)) || fail "the launcher adds $((with - without)) ms, allowed are 300"
    expect_builds 1
}

prints_one_line_and_exits_4_without_root() {
    make_tree "$work/tree"
    echo 'beta 1' >"$work/installed"
    run "$tree/clearway" list
    expect_equal "$code" 4
    expect_equal "$(grep -c . "$work/out" || true)" 0 'lines on stdout'
    expect_equal "$(grep -c apt-get "$work/err")" 1
    expect_line "$work/err" '^sudo apt-get install --no-install-recommends alpha$'
    expect_equal "$(<"$work/apt")" '' 'calls of apt-get'
    run "$tree/test"
    expect_equal "$code" 4
    expect_line "$work/err" '^sudo apt-get install --no-install-recommends alpha gamma$'
}

installs_what_is_missing_as_root() {
    make_tree "$work/tree"
    echo 0 >"$work/uid"
    echo 'beta 1' >"$work/installed"
    run "$tree/clearway" 0
    expect_equal "$code" 0
    expect_line "$work/err" 'installing 1 Debian packages: alpha$'
    expect_line "$work/err" 'text of apt-get'
    expect_no_line "$work/out" 'apt-get'
    expect_equal "$(wc -l <"$work/apt")" 2 'calls of apt-get'
    expect_line <(sed -n 1p "$work/apt") '^noninteractive .* update$'
    expect_line <(sed -n 2p "$work/apt") '^noninteractive .*-y .* install --no-install-recommends alpha$'
    run "$tree/clearway" 0
    expect_equal "$(wc -l <"$work/apt")" 2 'calls of apt-get when nothing is missing'
}

exits_4_when_installation_fails() {
    make_tree "$work/tree"
    echo 0 >"$work/uid"
    echo 'beta 1' >"$work/installed"
    touch "$work/apt_fails"
    run "$tree/clearway" 0
    expect_equal "$code" 4
    expect_line "$work/err" 'could not install: alpha$'
    expect_equal "$(grep -c . "$work/out" || true)" 0 'lines on stdout'
}

works_through_a_symlink_and_a_path_with_spaces() {
    make_tree "$work/a tree  with spaces"
    mkdir -p "$work/else where/links"
    ln -s "../../a tree  with spaces/clearway" "$work/else where/links/cw"
    cd -- "$work/else where"
    run ./links/cw 0 'relative file.toml'
    expect_equal "$code" 0
    expect_line "$work/out" '^arguments: <0> <relative file.toml>$'
    expect_line "$work/out" "^folder: $work/else where\$"
    PATH="$work/else where/links:$PATH" run cw 0 again
    expect_equal "$code" 0
    expect_line "$work/out" '<again>$'
    expect_builds 1
}

passes_arguments_input_and_exit_code() {
    make_tree "$work/tree"
    printf '#!/bin/sh\ncat\nprintf "<%%s>" "$@"\nexit 5\n' >"$tree/src/program.sh"
    printf 'input\n' >"$work/in"
    run "$tree/clearway" '' '*' "a'b" <"$work/in"
    expect_equal "$code" 5
    expect_equal "$(<"$work/out")" "input"$'\n'"<><*><a'b>"
    run "$tree/clearway"
    expect_equal "$(<"$work/err")" '' 'stderr once built'
}

builds_once_for_concurrent_starts() {
    make_tree "$work/tree"
    # The build lasts until the two other starts wait for it, 20 s at most.
    cat >>"$tree/src/build.sh" <<SH
for _ in \$(seq 200); do
    [ "\$(cat "$work"/err.* | grep -c 'waiting for another build')" = 2 ] && break
    sleep 0.1
done
SH
    local pids=() pid start
    for start in 1 2 3; do
        "$tree/clearway" 0 "start $start" >"$work/out.$start" 2>"$work/err.$start" &
        pids+=($!)
    done
    for pid in "${pids[@]}"; do
        wait "$pid" || fail "a concurrent start ended with $?: $(cat "$work"/err.*)"
    done
    expect_builds 1
    expect_equal "$(cat "$work"/out.* | grep -c '^arguments: <0> <start')" 3 'programs run'
    expect_equal "$(cat "$work"/err.* | grep -c 'waiting for another build')" 2 'starts that waited'
}

shows_the_end_of_a_failed_build() {
    make_tree "$work/tree"
    cp "$tree/src/build.sh" "$work/good.sh"
    echo 'echo "program.cpp:7: error: no such thing"; exit 3' >"$tree/src/build.sh"
    run "$tree/clearway" 0
    expect_equal "$code" 4
    expect_equal "$(grep -c . "$work/out" || true)" 0 'lines on stdout'
    expect_line "$work/err" 'program.cpp:7: error: no such thing'
    expect_line "$work/err" "log is in $tree/build/release/build.log\$"
    expect_line "$tree/build/release/build.log" 'program.cpp:7: error'
    run "$tree/clearway" 0
    expect_equal "$code" 4 'a second time'
    cp "$work/good.sh" "$tree/src/build.sh"
    run "$tree/clearway" 0
    expect_equal "$code" 0 'after the repair'
    echo 'syntax error(' >>"$tree/CMakeLists.txt"
    run "$tree/clearway" 0
    expect_equal "$code" 4 'configuring fails'
    expect_line "$work/err" 'CMake Error'
}

# Ctrl-C reaches the whole foreground process group; so does this. The wrapper gives the launcher a group of its own, with
# SIGINT not ignored.
interrupted_build_exits_130() {
    make_tree "$work/tree"
    sed -i "s|^set -e\$|set -e; touch '$work/compiling'; sleep 20|" "$tree/src/build.sh"
    set -m
    "$tree/clearway" 0 >"$work/out" 2>"$work/err" &
    local group=$! code=0
    for _ in {1..300}; do
        [[ -e $work/compiling ]] && break
        sleep 0.1
    done
    kill -INT -- "-$group"
    wait "$group" || code=$?
    set +m
    expect_equal "$code" 130
    sed -i 's|^set -e; .*$|set -e|' "$tree/src/build.sh"
    run "$tree/clearway" 0
    expect_equal "$code" 0 'the next start'
}

rebuilds_exactly_when_sources_change() {
    make_tree "$work/tree"
    run "$tree/clearway" 0
    run "$tree/clearway" 0
    touch "$tree/src/program.sh" "$tree/README.md"
    run "$tree/clearway" 0
    expect_builds 1 'nothing changed'
    sed -i 's/^echo "folder/echo "place/' "$tree/src/program.sh"
    run "$tree/clearway" 0
    expect_builds 2 'edited'
    expect_line "$work/out" '^place: '
    echo x >"$tree/src/one.part"
    run "$tree/clearway" 0
    expect_builds 3 'a file was added'
    rm "$tree/src/one.part"
    run "$tree/clearway" 0
    expect_equal "$code" 0 'a file was removed'
    local before
    before=$(wc -l <"$tree/builds")
    sed -i 's/^echo "place/echo "where/' "$tree/src/program.sh"
    touch -d '2001-01-01' "$tree/src/program.sh"
    run "$tree/clearway" 0
    expect_line "$work/out" '^where: '
    expect_builds $((before + 1)) 'new content with an old time, as unpacked from an archive'
    rm "$tree/build/release/bin/clearway"
    run "$tree/clearway" 0
    expect_equal "$code" 0 'the program was deleted'
}

rebuilds_after_a_package_changes() {
    make_tree "$work/tree"
    run "$tree/clearway" 0
    sed -i 's/^beta 1$/beta 2/' "$work/installed"
    run "$tree/clearway" 0
    expect_builds 2 'another version'
    sed -i 's/^gamma 1$/gamma 2/' "$work/installed"
    run "$tree/clearway" 0
    expect_builds 2 'of a package that only tests need'
}

rebuilds_after_the_tree_moves() {
    make_tree "$work/tree"
    run "$tree/clearway" 0
    mv "$work/tree" "$work/moved"
    tree=$work/moved
    run "$tree/clearway" 0
    expect_equal "$code" 0
    expect_line "$tree/build/release/CMakeCache.txt" "^CMAKE_HOME_DIRECTORY:INTERNAL=$tree\$"
}

sets_sumo_home() {
    make_tree "$work/tree"
    run "$tree/clearway" 0
    expect_line "$work/out" '^SUMO_HOME: /usr/share/sumo$'
    mkdir "$work/my sumo"
    SUMO_HOME="$work/my sumo" run "$tree/clearway" 0
    expect_line "$work/out" "^SUMO_HOME: $work/my sumo\$"
    SUMO_HOME=/no/such/folder run "$tree/clearway" 0
    expect_line "$work/out" '^SUMO_HOME: /usr/share/sumo$'
    expect_line "$work/err" 'SUMO_HOME=/no/such/folder is not a folder'
}

test_command_returns_the_verdict_of_ctest() {
    make_tree "$work/tree"
    run "$tree/test"
    expect_equal "$code" 0
    expect_line "$work/out" '^100% tests passed'
    echo 'echo "why it failed"; exit 1' >"$tree/src/verdict.sh"
    run "$tree/test"
    expect_equal "$code" 8 'ctest: tests failed'
    expect_line "$work/out" '^why it failed$'
    run "$tree/test" -R no_such_test
    ((code != 0)) || fail 'no test ran, and that passed'
}

test_command_explains_itself_without_building() {
    make_tree "$work/tree"
    run "$tree/test" --help
    expect_equal "$code" 0
    expect_line "$work/out" '^Everything that must pass: ./test'
    expect_no_line "$work/out" 'set -euo|^#'
    expect_builds 0
}

test_command_checks_the_format() {
    make_tree "$work/tree"
    printf 'int main( )  {return 0;}\n' >"$tree/src/ugly.cpp"
    run "$tree/test"
    expect_equal "$code" 1
    expect_line "$work/err" 'ugly.cpp:1:.*clang-format'
    expect_no_line "$work/out" 'tests passed'
    "$tree/scripts/check-format" --fix
    run "$tree/test"
    expect_equal "$code" 0 'after --fix'
}

# Each stage has its turn, and the tests of the build come last, so that their summary closes the log.
full_test_runs_every_stage() {
    make_tree "$work/tree"
    fake_checks
    printf '%s\n' 'delta 1' 'omega 1' >>"$work/installed"
    run "$tree/.ci/run"
    expect_equal "$code" 0
    expect_equal "$(grep -oE '^check-[a-z]*|^bare-machine run|^100% tests passed' "$work/out" | tr '\n' ',')" \
        'check-alone,check-tidy,100% tests passed,100% tests passed,bare-machine run,100% tests passed,'
    for stage in packages format 'build of ci' 'changed files' 'thread sanitizer' 'bare machine'; do
        expect_line "$work/err" "^ +[0-9]+ s  $stage\$"
    done
    expect_equal "$(cat "$tree"/built_* | wc -l)" 2 'builds for sanitizers'
    [[ -x $tree/build/ci/bin/clearway-train ]] || fail 'the trainer was not built'
}

full_test_fails_with_any_stage() {
    make_tree "$work/tree"
    fake_checks
    printf '%s\n' 'delta 1' 'omega 1' >>"$work/installed"
    for name in check-alone check-tidy bare-machine; do
        echo 1 >"$work/$name.code"
        run "$tree/.ci/run"
        ((code != 0)) || fail "$name found something, and that passed"
        rm "$work/$name.code"
    done
    echo 77 >"$work/bare-machine.code"
    run "$tree/.ci/run"
    expect_equal "$code" 0 'a machine that cannot make a bare one'
    echo 'echo "why it failed"; exit 1' >"$tree/src/verdict.sh"
    run "$tree/.ci/run"
    expect_equal "$code" 8 'ctest: tests failed'
}

# One that passes by skipping a part of it would be taken for one that has run, in any stage.
full_test_fails_where_a_test_is_skipped() {
    make_tree "$work/tree"
    fake_checks
    printf '%s\n' 'delta 1' 'omega 1' >>"$work/installed"
    printf '%s\n' 'case $PWD in */build/ci*) echo "/a_test.cpp:7: Skipped"; echo "python3-h5py is not installed" ;; esac' >"$tree/src/verdict.sh"
    run "$tree/test"
    expect_equal "$code" 0 'without --full'
    run "$tree/.ci/run"
    expect_equal "$code" 1
    expect_line "$work/out" '^check-skips: verdict: python3-h5py is not installed$'
    sed -i 's|build/ci|build/asan|' "$tree/src/verdict.sh"
    run "$tree/.ci/run"
    expect_equal "$code" 1 'skipped under a sanitizer'
    sed -i 's|python3-h5py.*installed"|mounting a small file system is not permitted"|' "$tree/src/verdict.sh"
    run "$tree/.ci/run"
    expect_equal "$code" 0 'a reason that is allowed'
}

# libtorch is for those who train: `./clearway links train` brings it, and from then on the trainer is kept up to date.
trainer_comes_with_the_first_training() {
    make_tree "$work/tree"
    echo 0 >"$work/uid"
    run "$tree/clearway" 0
    expect_equal "$(<"$work/apt")" '' 'calls of apt-get for a run'
    [[ ! -e $tree/build/release/bin/clearway-train ]] || fail 'a run built the trainer'
    run "$tree/clearway" links train
    expect_line "$work/err" 'installing 1 Debian packages: delta$'
    expect_line "$work/out" '^arguments: <links> <train>$'
    [[ -x $tree/build/release/bin/clearway-train ]] || fail 'the trainer was not built'
    expect_builds 1 'libtorch changes no other program'
    echo '# new' >>"$tree/src/trainer.sh"
    run "$tree/clearway" 0
    expect_equal "$(tail -n 1 "$tree/build/release/bin/clearway-train")" '# new' 'the trainer after a run'
    sed -i 's/^delta 1$/delta 2/' "$work/installed"
    run "$tree/clearway" 0
    expect_builds 2 'another version of libtorch'
    sed -i '/^delta/d' "$work/installed"
    run "$tree/clearway" 0
    expect_equal "$code" 0 'libtorch was removed'
    echo 1000 >"$work/uid"
    run "$tree/clearway" links train
    expect_equal "$code" 4
    expect_line "$work/err" '^sudo apt-get install --no-install-recommends delta$'
}

installs_the_programs_into_a_folder() {
    make_tree "$work/tree"
    run "$tree/clearway" install --to "$work/a home"
    expect_equal "$code" 0
    expect_line "$work/err" "^clearway: add $work/a home/bin to PATH\$"
    rm -rf -- "$tree"
    PATH="$work/a home/bin:$PATH" run clearway 0 x
    expect_line "$work/out" '^arguments: <0> <x>$'
    make_tree "$work/tree"
    run "$tree/clearway" install "$work/other"
    expect_equal "$code" 2 'no --to'
    : >"$work/file"
    run "$tree/clearway" install --to "$work/file/below"
    expect_equal "$code" 4 'a folder that cannot be made'
    expect_line "$work/err" "^clearway: cannot install into $work/file/below: "
}

package_list_is_well_formed() {
    local name part purpose
    while read -r name part purpose; do
        [[ -z $name || $name == '#'* ]] && continue
        [[ $name =~ ^[a-z0-9][a-z0-9.+-]+$ ]] || fail "not a package name: $name"
        [[ $part == run || $part == test || $part == train || $part == extra || $part == package ||
            $part == fuzz ]] ||
            fail "$name: part $part"
        [[ -n $purpose ]] || fail "$name: who needs it?"
    done <"$source_dir/packaging/packages.txt"
    expect_equal "$(grep -v '^#' "$source_dir/packaging/packages.txt" | cut -d' ' -f1 | sort | uniq -d)" '' 'duplicates'
}

[[ $(type -t "$case") == function ]] || fail "no such case: $case"
"$case"
