# What the scripts beside it share; they source it. Leaves the shell in the repository.
# shellcheck shell=bash
CDPATH="" cd -- "$(dirname -- "${BASH_SOURCE[0]}")/../.." || exit
exec </dev/null

say() { printf '== %s\n' "$*" >&2; }

give_up() {
    printf '%s: %s\n' "${0##*/}" "$*" >&2
    exit 2
}

fail() {
    printf '%s: FAILED: %s\n' "${0##*/}" "$*" >&2
    exit 1
}

# need_packages TEST PACKAGE...: installs them unless the command TEST succeeds.
need_packages() {
    local test=$1
    shift
    ! (eval "$test") >/dev/null 2>&1 || return 0
    [[ -e /etc/debian_version ]] || give_up "this needs Debian or Ubuntu, and their packages $*"
    ((EUID == 0)) || give_up "not root; as root, run: apt-get update && apt-get install $*"
    say "installing $*"
    apt-get update || say "the package lists are not up to date"
    DEBIAN_FRONTEND=noninteractive apt-get install --yes --no-install-recommends "$@" ||
        give_up "cannot install $*"
}

build_folder() { printf '%s' "${CARGO_TARGET_DIR:-$PWD/target}"; }

# The program under test: CANDOR, or what this repository builds.
candor_program() {
    [[ -n ${CANDOR-} ]] || cargo build --release --locked --quiet
    realpath -e -- "${CANDOR:-$(build_folder)/release/candor}"
}

# Runs $candor; only its errors are shown.
run_quietly() { "$candor" "$@" --quiet >/dev/null; }

same_pixels() { tests/cluster/same_pixels "$@"; }

# refused WORDS COMMAND...: the command must fail, and say these words.
refused() {
    local wanted=$1 said
    shift
    ! said=$("$@" 2>&1) || fail "was not refused: $*"
    [[ $said == *"$wanted"* ]] || fail "was refused for another reason than '$wanted': $said"
}
