"""A scene in, everything that is done with it out: functions, answers, motions, files, checks.

>>> from derive import load
>>> runner = load("edge_runner_flat")
>>> round(runner.solve({"m": 1200, "r": 0.6, "L": 0.9, "W": 3.2, "g": 9.81})["N"], 9)
15458.4
"""
