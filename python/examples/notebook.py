"""What clearance does to a slider-crank: cells to be opened as a notebook (Jupytext, VS Code), or run as they are."""

# %% A machine: the template of a slider-crank, with play in both pins of the rod.
import numpy as np
import pyfreeplay as fp

crank = fp.Scenario({"mechanism": {"kind": "slider-crank"}, "simulation": {"duration": 0.1}})
machine = crank.set("joints.clearance", 2e-4)
machine

# %% What can be said without simulating.
fp.check(machine)

# %% A run: the machine as it moves, the orbits of its journals, how it went.
run = fp.run(machine)
run

# %% Its columns are arrays.
names = [joint["joint"] for joint in run.summary["joints"] if joint["clearance_m"]]
{name: float(np.max(run[f"force_{name}"])) for name in names}

# %% How do forces and errors grow with the clearance?
sweep = fp.sweep(crank, {"joints.clearance": "1e-5..1e-3:log:6"})
sweep

# %% The same as a table of numbers.
np.column_stack([sweep["joints.clearance"], sweep["peak_contact_force_N"], sweep["max_path_error_m"]])

# %% Another law of contact, as a function: a spring without losses.
fp.evaluate(
    machine.set("simulation.duration", 0.02), ["peak_contact_force_N"], law=lambda depth, rate: 1e7 * depth
)
