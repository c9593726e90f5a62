"""A column of water collapses: three transfers of velocity between markers and grid, compared with Martin & Moyce (1952).

    PYTHONPATH=build/release/python /usr/bin/python3 docs/example/dam_break.py fronts.png
"""
import sys
import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
import weir

case, a, g = "dam_break_martin_moyce", 0.05715, 9.81  # base of the column [m], gravity [m/s^2]
T, Z = np.loadtxt(weir.case_folder(case) / "data/martin_moyce1952_n2eq2_front.csv", delimiter=",", skiprows=4).T
plt.plot(T, Z, "ko", label="experiment")
for transfer in ("flip", "apic", "pic"):
    sim = weir.Simulation(case, set={"grid.cells": [216, 45], "time.end": 0.19, "scheme.transfer": transfer},
                          measure="front.mean_error", reference=case)
    sim.run()
    front = sim.probes["front"]
    plt.plot(front.times * np.sqrt(2 * g / a) + 0.175, front[0] / a, label=transfer)  # shifted by the gate, as others do
    print(transfer, repr(sim.measured()["front.mean_error"]))
plt.xlim(0, 3.4), plt.ylim(1, 5), plt.xlabel("T = t sqrt(2g/a)"), plt.ylabel("Z = x/a"), plt.legend()
plt.savefig(sys.argv[1])
