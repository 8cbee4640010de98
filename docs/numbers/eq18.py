"""By how much eq. 18, the mean angle of the rods with phi in [0, pi/2], exceeds that of all rods folded into it.

    eq18.py rods.csv    prints the mean over replicas and its standard error, in rad
"""

import csv
import math
import statistics
import sys
from collections import defaultdict

kept, folded = defaultdict(list), defaultdict(list)
with open(sys.argv[1]) as rods:
    for row in csv.DictReader(rods):
        phi = math.atan2(float(row["p2"]), float(row["p1"])) % math.pi
        if phi <= math.pi / 2:
            kept[row["replica"]].append(phi)
        folded[row["replica"]].append(min(phi, math.pi - phi))
differences = [statistics.fmean(kept[replica]) - statistics.fmean(folded[replica]) for replica in folded]
se = statistics.stdev(differences) / math.sqrt(len(differences))
print(f"{statistics.fmean(differences):.4f} ± {se:.4f}".replace("-", "−").replace("−0.0000", "0.0000"), end="")
