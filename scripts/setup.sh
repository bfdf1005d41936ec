# shellcheck shell=bash
# Set-up shared by `clearway` and `test`: Debian packages, SUMO_HOME, configure and build.
# Sourced by a bash script that has set `root` to the top folder of the tree, under `set -euo pipefail`.
# Everything here talks on stderr. What the machine lacks ends the calling script with exit code 4.

: "${root:?the sourcing script sets root}"
readonly exit_environment=4

say() { printf 'clearway: %s\n' "$*" >&2; }

fail_environment() {
    say "$@"
    exit "$exit_environment"
}

# Prints the names in the package list that belong to one of the given parts, one per line.
packages_of() {
    local package part wanted
    while read -r package part _; do
        [[ -z $package || $package == '#'* ]] && continue
        for wanted in "$@"; do
            [[ $part == "$wanted" ]] && printf '%s\n' "$package"
        done
    done <"$root/packaging/packages.txt"
    return 0
}

# Sets `installed_packages` (lines `name version`) and `missing_packages` for the names given.
# One call of dpkg-query: 10 ms, and right whatever was installed or removed since the last launch.
query_packages() {
    command -v dpkg-query >/dev/null || fail_environment "this is not a Debian system (no dpkg-query)." \
        "Install the counterparts of packaging/packages.txt, then: cmake --preset release && cmake --build --preset release"
    local name status version package
    declare -A found=()
    installed_packages=''
    # dpkg-query fails when it does not know a package at all; that package then has no line.
    while read -r name status version; do
        [[ $status == installed ]] || continue
        found[$name]=1
        installed_packages+="$name $version"$'\n'
    done < <(dpkg-query -W -f '${Package} ${db:Status-Status} ${Version}\n' "$@" 2>/dev/null || true)
    missing_packages=()
    for package in "$@"; do
        [[ -n ${found[$package]:-} ]] || missing_packages+=("$package")
    done
}

# Installs `missing_packages` with the lock held. apt-get must not inherit the lock (descriptor 9): a service that it
# starts would hold it for ever.
install_missing() {
    local apt=(apt-get -q -y -o DPkg::Lock::Timeout=600)
    say "installing ${#missing_packages[@]} Debian packages: ${missing_packages[*]}"
    export DEBIAN_FRONTEND=noninteractive
    "${apt[@]}" update </dev/null 9>&- >&2 || say "apt-get update failed; trying with the package lists at hand"
    "${apt[@]}" install --no-install-recommends "${missing_packages[@]}" </dev/null 9>&- >&2 ||
        fail_environment "apt-get could not install: ${missing_packages[*]}"
}

# Makes sure that the packages of the given parts are installed. Leaves `installed_packages` set.
ensure_packages() {
    local wanted
    mapfile -t wanted < <(packages_of "$@")
    query_packages "${wanted[@]}"
    ((${#missing_packages[@]} > 0)) || return 0
    if [[ $(id -u) != 0 ]]; then
        say "${#missing_packages[@]} Debian packages are missing. Install them with:"
        printf 'sudo apt-get install --no-install-recommends %s\n' "${missing_packages[*]}" >&2
        exit "$exit_environment"
    fi
    mkdir -p "$root/build"
    (
        flock 9
        query_packages "${wanted[@]}"
        ((${#missing_packages[@]} == 0)) || install_missing
    ) 9>"$root/build/.packages.lock"
    query_packages "${wanted[@]}"
    ((${#missing_packages[@]} == 0)) || fail_environment "still missing after installation: ${missing_packages[*]}"
}

# Sets `training` to ON or OFF and `training_packages` to the packages (lines `name version`) that the trainer is built with.
#   `train`: installs them. `keep PRESET`: ON if the preset has a trainer and its packages are still there, so that it is kept
#   up to date with the other programs. `find`: ON where they are installed.
# Call it before ensure_packages, which sets `installed_packages`.
choose_training() {
    local mode=$1 names
    training=OFF
    training_packages=''
    if [[ $mode == keep && ! -x $root/build/$2/bin/clearway-train ]]; then return; fi
    if [[ $mode == train ]]; then ensure_packages run train; fi
    mapfile -t names < <(packages_of train)
    if ((${#names[@]} == 0)); then return; fi
    query_packages "${names[@]}"
    if ((${#missing_packages[@]} == 0)); then
        training=ON
        training_packages=$installed_packages
    fi
}

# SUMO finds its schemas and data through SUMO_HOME.
ensure_sumo_home() {
    local standard=/usr/share/sumo
    if [[ -n ${SUMO_HOME:-} && ! -d $SUMO_HOME ]]; then
        say "SUMO_HOME=$SUMO_HOME is not a folder; using $standard"
        SUMO_HOME=
    fi
    export SUMO_HOME=${SUMO_HOME:-$standard}
}

# Prints what a build of the preset depends on: the place of the tree, the package versions, the content of the sources.
# Content, not time: an unpacked archive or `cp -p` brings new files with old times.
fingerprint() {
    local preset=$1 sources=(src programs cmake CMakeLists.txt CMakePresets.json) present=() source
    [[ $preset == release ]] || sources+=(tests benchmarks)
    for source in "${sources[@]}"; do
        [[ -e $root/$source ]] && present+=("$source")
    done
    printf 'tree %s\n' "$root"
    printf 'package %s\n' "${installed_packages//$'\n'/; }"
    printf 'training %s %s\n' "$training" "${training_packages//$'\n'/; }"
    (cd -- "$root" && find "${present[@]}" -type f -print0 | LC_ALL=C sort -z | xargs -0 sha256sum)
}

# Whether the preset's programs are those of the tree as it is.
build_is_current() {
    local folder=$root/build/$1
    [[ -x $folder/bin/clearway && -r $folder/.clearway-built &&
        $(<"$folder/.clearway-built") == "$(fingerprint "$1")" ]]
}

# Prints `yes` when Ninja, which goes by file times, would miss a change since the last build: other package versions
# (their headers keep the packager's times), or a source whose content is new but whose time is not.
# Takes the file of the last build's fingerprint; reads the new fingerprint from standard input.
change_hidden_from_ninja() {
    local built=$1 line
    while IFS= read -r line; do
        case $line in
            tree\ * | 'training OFF '*) ;;
            training\ *) # the first time nothing has been built with these packages
                if grep -q '^training ON ' "$built"; then
                    echo yes
                    return
                fi
                ;;
            package\ *)
                echo yes
                return
                ;;
            *)
                if [[ ! $root/${line:66} -nt $built ]]; then
                    echo yes
                    return
                fi
                ;;
        esac
    done < <(LC_ALL=C comm -13 <(LC_ALL=C sort "$built") <(LC_ALL=C sort))
}

# Prints the number of compile jobs: one per core, and 1.5 GB of free memory for each (a libtorch file takes that much).
compile_jobs() {
    local cores free_kib=0 key value jobs
    cores=$(nproc)
    while read -r key value _; do
        [[ $key == MemAvailable: ]] && free_kib=$value
    done </proc/meminfo
    jobs=$((free_kib / 1500000))
    ((jobs >= 1)) || jobs=1
    ((jobs <= cores)) || jobs=$cores
    printf '%s\n' "${CMAKE_BUILD_PARALLEL_LEVEL:-$jobs}"
}

# Copies a build's output to the log and shows its progress: on a terminal one line that renews itself, otherwise one line
# per 10 s.
show_progress() {
    local log=$1 line last_s=$SECONDS
    while IFS= read -r line; do
        printf '%s\n' "$line" >>"$log"
        [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]] || continue
        if [[ -t 2 ]]; then
            printf '\rclearway: building %s of %s\e[K' "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}" >&2
        elif ((SECONDS - last_s >= 10)); then
            say "building ${BASH_REMATCH[1]} of ${BASH_REMATCH[2]}"
            last_s=$SECONDS
        fi
    done
    if [[ -t 2 ]]; then printf '\r\e[K' >&2; fi
}

# Runs a command and adds a line with its name and seconds to `stages`.
stages=''
stage() {
    local name=$1 start=$EPOCHSECONDS
    shift
    "$@"
    stages+=$(printf '%6d s  %s' $((EPOCHSECONDS - start)) "$name")$'\n'
    say "stage $name: $((EPOCHSECONDS - start)) s"
}

# Ends the script after a failed step of a build.
fail_build() {
    local preset=$1 log=$2
    say "building '$preset' failed; the last lines:"
    tail -n 40 -- "$log" | sed 's/^/    /' >&2
    fail_environment "the whole log is in $log"
}

# Configures and builds with the lock held: all, or one target. `wanted_build` is set.
configure_and_build() {
    local preset=$1 target=${2:-} folder=$root/build/$1
    local log=$folder/build.log built=$folder/.clearway-built configure=() build=()
    mkdir -p "$folder"
    : >"$log"
    if [[ -r $folder/CMakeCache.txt ]] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$root" "$folder/CMakeCache.txt"; then
        configure+=(--fresh) # the tree was moved together with its build folder
    fi
    # Sanitizers look at no library of others, and libtorch is one.
    if [[ $preset != [at]san && $preset != fuzz ]]; then configure+=("-DCLEARWAY_TRAINING=$training"); fi
    if [[ $preset == ci && -n ${fast_tests:-} ]]; then configure+=("-DCLEARWAY_FAST_TESTS=$fast_tests"); fi
    # One clone finds what another has compiled, where messages do not tell the difference.
    export CCACHE_BASEDIR=${CCACHE_BASEDIR:-$root} CCACHE_ABSSTDERR=1
    if [[ -r $built && $(change_hidden_from_ninja "$built" <<<"$wanted_build") == yes ]]; then
        build+=(--clean-first)
    fi
    # Written before the build starts, so that its time is older than any edit made while the build runs.
    printf '%s\n' "$wanted_build" >"$built.new"
    (cd -- "$root" && cmake --preset "$preset" "${configure[@]}") </dev/null >>"$log" 2>&1 || fail_build "$preset" "$log"
    if [[ -n $target ]]; then build+=(--target "$target"); fi
    cmake --build "$folder" --parallel "$(compile_jobs)" "${build[@]}" </dev/null 2>&1 | show_progress "$log" ||
        fail_build "$preset" "$log"
    [[ -n $target || -x $folder/bin/clearway ]] || fail_environment "the build of '$preset' left no $folder/bin/clearway"
    mv -- "$built.new" "$built"
}

# Runs a command with the preset's build lock: of several launches at once one builds, and the others wait for it.
# Ninja keeps the lock (descriptor 9) when this script is killed, so that no second Ninja joins it in one folder.
with_build_lock() {
    local preset=$1
    shift
    mkdir -p "$root/build"
    (
        if ! flock -n 9; then
            say "waiting for another build of '$preset'"
            flock 9
        fi
        "$@"
    ) 9>"$root/build/.$preset.lock"
}

# Configures and builds the preset, or one target of it, current or not.
update_build() {
    wanted_build=$(fingerprint "$1")
    say "building '$1' (log: $root/build/$1/build.log)"
    SECONDS=0
    configure_and_build "$@"
    say "built '$1' in $SECONDS s"
}

update_build_unless_current() {
    if ! build_is_current "$1"; then update_build "$1"; fi
}

# Copies the release programs and their files below a folder, and ends the calling script.
install_built() {
    [[ $# == 2 && $1 == --to && -n $2 ]] || {
        say "usage: ./clearway install --to DIR, for example ~/.local"
        exit 2
    }
    local prefix
    prefix=$(readlink -m -- "$2")
    cmake --install "$root/build/release" --prefix "$prefix" >"$root/build/install.log" 2>&1 ||
        fail_environment "cannot install into $prefix: $(tail -n 1 "$root/build/install.log"). Choose a folder that you may write to"
    say "installed: $prefix/bin/clearway"
    if [[ :$PATH: != *":$prefix/bin:"* ]]; then say "add $prefix/bin to PATH"; fi
    exit 0
}

# Brings build/PRESET up to date; costs one reading of the sources when it is.
ensure_built() {
    if ! build_is_current "$1"; then with_build_lock "$1" update_build_unless_current "$1"; fi
}
