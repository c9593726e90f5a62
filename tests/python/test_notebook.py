"""The notebook of the dam break runs from its first cell to its last, and shows pictures."""
import json
import os
import subprocess
import sys

from conftest import source


def main():
    try:
        import ipykernel  # noqa: F401
        import nbconvert  # noqa: F401
    except ImportError:
        print("skipped: no nbconvert (Debian: apt-get install jupyter-nbconvert python3-ipykernel)")
        return 77
    import tempfile
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "MPLCONFIGDIR": folder, "IPYTHONDIR": folder, "JUPYTER_DATA_DIR": folder, "HOME": folder}
        environment.pop("MPLBACKEND", None)
        environment["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"
        subprocess.run([sys.executable, "-m", "nbconvert", "--to", "notebook", "--execute", "--output-dir", folder, "--log-level", "ERROR",
                        source / "docs/example/dam_break.ipynb"], check=True, env=environment)
        with open(os.path.join(folder, "dam_break.ipynb")) as file:
            cells = [cell for cell in json.load(file)["cells"] if cell["cell_type"] == "code"]
    pictures = [cell for cell in cells if any("image/png" in output.get("data", {}) for output in cell["outputs"])]
    assert all(cell["execution_count"] for cell in cells) and len(pictures) >= 5, len(pictures)
    return 0


if __name__ == "__main__":
    sys.exit(main())
