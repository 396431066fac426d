"""Makes the first inputs of each target from the meshes of tests/: a byte that chooses the format, then the mesh.

    python seeds.py    # writes fuzz/corpus/TARGET/
"""
import re
from pathlib import Path

FUZZ = Path(__file__).resolve().parent
MESHES = FUZZ.parent / "tests/meshes"
LARGEST = 20_000

families = re.findall(r"pub const (\w+): &\[&str\] = &\[(.*?)\];", (FUZZ / "src/lib.rs").read_text(), re.DOTALL)
for target, names in families:
    into = FUZZ / "corpus" / target.lower()
    into.mkdir(parents=True, exist_ok=True)
    for choice, name in enumerate(re.findall(r'"(\w+)"', names)):
        for mesh in sorted((MESHES / name).glob("*")):
            if mesh.is_file() and mesh.stat().st_size <= LARGEST:
                (into / f"{name}-{mesh.name}").write_bytes(bytes([choice]) + mesh.read_bytes())
