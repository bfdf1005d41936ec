# shellcheck shell=sh
# Sourced by scripts (bash or sh): what they do with --help and with options that they do not have.

# help_or_refuse OPTIONS ARGUMENT...: for --help or -h prints the comment at the head of the script and ends it with 0. Ends it
# with 2 for an option that is not one of OPTIONS (words in one text). Looks at the arguments up to the first that is no option.
help_or_refuse() {
    _options=$1
    shift
    while [ $# -gt 0 ]; do
        case $1 in
            --help | -h)
                sed -n '2,${/^#/!q;/shellcheck/!s/^# \{0,1\}//p;}' "$0"
                exit 0
                ;;
            -*)
                case " $_options " in
                    *" $1 "*) ;;
                    *)
                        echo "${0##*/}: $1 is not an option of it (allowed: ${_options:+$_options }--help)" >&2
                        exit 2
                        ;;
                esac
                ;;
            *) return 0 ;;
        esac
        shift
    done
}
