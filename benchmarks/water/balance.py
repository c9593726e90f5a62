#!/usr/bin/env python3
"""balance.py WEIR CASES [WORD...]: how much volume and energy water loses or gains that breaks up, by every transfer of mac_water and by
tallcell, in 2D and 3D, at three resolutions. A line a run, as a row of Markdown: the final volume's relative error, and the highest total
energy above the start, over that above the floor (of sloshing: over the energy of its waves). WORDs: scenes
whose names have one of them."""
import json
import pathlib
import subprocess
import sys
import tempfile

weir, cases = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
words = sys.argv[3:]
g3 = "effects.gravity.g = [0.0, -9.81, 0.0]"
gaps = [(-1.0, 0.04), (0.1, 0.22), (0.28, 0.4), (0.46, 1.0)]
plates = ", ".join(f'{{ shape = "box", min = [{a}, 0.5, -1.0], max = [{b}, 0.62, 1.0] }}' for a, b in gaps)
cup = ('{ shape = "difference", from = { shape = "box", min = [0.25, 0.25, 0.25], max = [0.75, 0.75, 0.75] }, '
       'minus = [ { shape = "box", min = [0.38125, 0.38125, 0.38125], max = [0.61875, 1.2, 0.61875] } ] }')
# name: case, cells at the coarsest, end [s], settings
scenes = {
    "sieve": ("everyday_sieve", [32, 64], 4, []),
    "tap": ("everyday_tap", [32, 32], 1, []),
    "cup": ("everyday_cup", [32, 32], 3, []),
    "wall jet": ("dam_break_martin_moyce", [72, 48], 3, []),
    "sloshing": ("everyday_sloshing", [32, 24], 40, []),
    "sieve 3D": ("everyday_sieve", [16, 32, 4], 1.5, ["dim = 3", "grid.size = [0.5, 1.0, 0.125]", g3,
                 'liquid = [ { shape = "box", min = [-0.1, 0.62, -1.0], max = [0.6, 0.9, 1.0] } ]', f"solids = [ {plates} ]"]),
    "tap 3D": ("everyday_tap", [16, 16, 16], 0.5, ["dim = 3", "grid.size = [0.1, 0.1, 0.1]", g3,
               "liquid[0].min = [0.0, 0.0, 0.0]", "liquid[0].max = [0.1, 0.01, 0.1]",
               'emitters = [ { shape = "box", min = [0.04, 0.08, 0.04], max = [0.06, 0.09, 0.06], velocity = [0.0, -0.5, 0.0], end = 0.2 } ]']),
    "cup 3D": ("everyday_cup", [16, 16, 16], 1, ["dim = 3", "grid.size = [1.0, 1.0, 1.0]", g3, f"solids = [ {cup} ]",
               'liquid = [ { shape = "box", min = [0.38125, 0.38125, 0.38125], max = [0.61875, 0.6, 0.61875] } ]']),
    "sloshing 3D": ("everyday_sloshing", [16, 12, 8], 10, ["dim = 3", "grid.size = [1.0, 0.75, 0.5]", g3,
                    'liquid = [ { shape = "plane", point = [0.5, 0.4, 0.25], normal = [-0.2, 1.0, 0.1] } ]']),
}
methods = {t: ["solver = \"mac_water\"", f"scheme.transfer = \"{t}\""] for t in ("flip", "apic", "pic", "grid")}
methods["tallcell"] = ["solver = \"tallcell\"", "scheme = {}"]
frames = 200  # at each of which the energy is looked at


def balance(case, cells, end, settings, folder):
    pe = "probes = [ { name = \"pe\", kind = \"integral\", field = \"potential_energy\" } ]"
    every = f"output = {{ every = {end / frames}, fields = [\"pressure\"] }}"
    wanted = settings + [f"grid.cells = {cells}", f"time.end = {end}", every, pe]
    command = [weir, "run", cases / case / "scene.toml", "--quiet", "--threads", "1", "--out", folder]
    for line in wanted:
        key, value = line.split(" = ", 1)
        command += ["--set", f"{key}={value}"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        return None, done.stderr.strip().splitlines()[-2:]
    return json.loads((folder / "run.json").read_text())["balance"]["quantities"], None


print("| scene | method | cells | volume | energy above its start |\n|---|---|---|---|---|")
for name, (case, coarsest, end, settings) in scenes.items():
    if words and not any(word in name for word in words):
        continue
    for method, choice in methods.items():
        if method == "tallcell" and name.startswith("tap"):
            continue  # it has no emitters
        for factor in (1, 1.5, 2):
            cells = [round(n * factor) for n in coarsest]
            with tempfile.TemporaryDirectory() as folder:
                q, error = balance(case, cells, end, choice + settings, pathlib.Path(folder) / "run")
            size = "x".join(map(str, cells))
            if error:
                print(f"| {name} | {method} | {size} | {' '.join(error)} | |", flush=True)
                continue
            volume, energy = q["volume"], q["energy"]
            at_rest = 1000 * 9.81 * volume["start"] ** 2 / 2 / (0.5 if "3D" in name else 1) if name.startswith("sloshing") else 0
            gain = "poured" if name.startswith("tap") else f"{100 * (energy['highest'] / energy['start'] - 1) / (1 - at_rest / energy['start']):+.2f}%"
            print(f"| {name} | {method} | {size} | {volume['unexplained']:+.1e} | {gain} |", flush=True)
