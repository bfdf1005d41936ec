"""What scripts without options of their own do with their arguments."""
import pathlib
import signal
import sys


def words(doc, least, most=None):
    """The arguments of the script, of which there are `least` to `most`. Ends it with its text for --help, with 2 for an option in
    place of the first argument, or for too few or too many arguments. Who reads the output may stop, as head does."""
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)
    given = sys.argv[1:]
    if given[:1] in (["--help"], ["-h"]):
        print(doc)
        sys.exit(0)
    if given and given[0].startswith("-"):
        print(f"{pathlib.Path(sys.argv[0]).name}: {given[0]} is not an option of it (allowed: --help)", file=sys.stderr)
        sys.exit(2)
    if len(given) < least or (most is not None and len(given) > most):
        print(doc, file=sys.stderr)
        sys.exit(2)
    return given
