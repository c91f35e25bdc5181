"""Programs that are run in the folder of the films, candor among them."""

import subprocess
import sys
from pathlib import Path

from film import Film


class Tools:
    """Runs programs in a folder."""

    def __init__(self, folder, candor):
        self.folder, self.candor_path = Path(folder), candor

    def run(self, *command):
        """Its exit code, and all that it said."""
        done = subprocess.run(command, cwd=self.folder, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, check=False)
        return done.returncode, done.stdout

    def ok(self, *command):
        """What it said; the check ends here if it fails."""
        code, said = self.run(*command)
        if code != 0:
            sys.exit(f"FAILED  {' '.join(command)}: exit code {code}\n{said}")
        return said

    def candor(self, *arguments):
        """Runs candor."""
        return self.run(self.candor_path, *arguments)

    def film(self, name):
        """A film of the folder."""
        return Film(self.folder / name)
