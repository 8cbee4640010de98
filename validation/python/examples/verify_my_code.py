"""fiberoripy's Jeffery equation graded, with the picture: pip install shearbed fiberoripy==1.4.0 scipy matplotlib

fiberoripy turns tensors: a rod is the tensor pp, for which the quadratic closure is exact, and comes back as its eigenvector.
It passes at r_e = 2 and 11.6. At 100 and 10 000 it ends without a word, and is wrong.
"""

import numpy as np
from fiberoripy.closures import compute_closure
from fiberoripy.orientation import integrate_ori_ode, jeffery_ode
from scipy.integrate import solve_ivp

import shearbed


def fiberoripy(gradient_per_s, aspect_ratio, start, times_s, steps):
    shape = {"xi": (aspect_ratio**2 - 1) / (aspect_ratio**2 + 1)}
    terms = (lambda t: gradient_per_s, lambda a: compute_closure(a, "QUADRATIC"), jeffery_ode, shape)

    def rod(p):
        pp, span = np.outer(p, p).ravel(), (0, times_s[-1])
        found = solve_ivp(integrate_ori_ode, span, pp, "DOP853", times_s, args=terms, rtol=1e-12, atol=1e-12)
        return np.linalg.eigh(found.y.T.reshape(-1, 3, 3)).eigenvectors[:, :, 2]

    return np.stack([rod(p) for p in start], axis=1)


report = shearbed.grade(fiberoripy, steps=(1,), names=["mid-flip-2", "mid-flip-11.6", "mid-flip-100", "mid-flip-10000"])
print(report)
report.plot().figure.savefig("verify_my_code.png", dpi=150)
