"""Checks that every package of tests/requirements.txt is installed; without them other tests leave checks out."""
import importlib.metadata
import pathlib
import sys


def is_installed(name):
    try:
        return bool(importlib.metadata.version(name))
    except importlib.metadata.PackageNotFoundError:
        return False


lines = (pathlib.Path(__file__).parent.parent / 'requirements.txt').read_text().splitlines()
names = [line.split('==')[0] for line in lines if '==' in line]
missing = [name for name in names if not is_installed(name)]
if missing:
    print('skipped: {} has no {}; tools/test-python.sh installs them'.format(sys.executable, ', '.join(missing)))
    sys.exit(77)
