"""What the scripts of this folder share."""
import os
import shutil
import subprocess
import sys

SKIPPED = 77


def require_strace(*options):
    """Ends the script, saying so, where strace is missing or may not do what these options ask."""
    probe = ["strace", "-qq", "-o", os.devnull, *options, "true"]
    if shutil.which("strace") is None or subprocess.run(probe, check=False, capture_output=True).returncode:
        print("strace is not installed or may not trace: skipped")
        sys.exit(SKIPPED)
