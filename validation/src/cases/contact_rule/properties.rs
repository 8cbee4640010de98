//! The invariants of the contact rule, each with its violation.

use super::*;

type Property = fn(ContactRule, &Pair) -> Option<f64>;

fn changed(pair: &Pair, change: impl Fn(&mut Pair, usize)) -> Pair {
    let mut changed = *pair;
    (0..2).for_each(|k| change(&mut changed, k));
    changed
}

fn difference(a: [Vector3<f64>; 2], b: [Vector3<f64>; 2]) -> f64 {
    (a[0] - b[0]).norm() + (a[1] - b[1]).norm()
}

/// Each invariant with its violation, 0 where it holds.
pub(super) const PROPERTIES: [(&str, Property); 11] = [
    ("velocity normal to the contact line unchanged (eq. 5, A.9)", |rule, pair| {
        let after = rule(pair)?;
        let (line, _) = geometry(pair);
        let change = |k: usize| {
            let dv = contact_velocities(pair, &after)[k] - contact_velocities(pair, &pair.rate)[k];
            (dv - line * line.dot(&dv)).norm()
        };
        Some(larger(change(0), change(1)))
    }),
    ("velocities along the contact line equal (eq. 6, A.10)", |rule, pair| {
        let [a, b] = contact_velocities(pair, &rule(pair)?);
        Some(geometry(pair).0.dot(&(a - b)).abs())
    }),
    ("their sum kept (eq. 6)", |rule, pair| {
        let sum = |rate: &[Vector3<f64>; 2]| {
            let [a, b] = contact_velocities(pair, rate);
            geometry(pair).0.dot(&(a + b))
        };
        Some((sum(&rule(pair)?) - sum(&pair.rate)).abs())
    }),
    ("ṗ′ normal to p, and |p| = 1 after either update", |rule, pair| {
        let after = rule(pair)?;
        let off = |k: usize| {
            let lengths = [turn(&pair.p[k], &after[k], 0.1).0, step_angles(&pair.p[k], &after[k], 0.1).0];
            let stretched = lengths.iter().map(|p| (p.norm() - 1.0).abs()).fold(0.0, larger);
            stretched + after[k].dot(&pair.p[k]).abs()
        };
        Some(larger(off(0), off(1)))
    }),
    ("A and B exchanged", |rule, pair| {
        let swapped = changed(pair, |swapped, k| {
            let other = 1 - k;
            (swapped.x[k], swapped.p[k]) = (pair.x[other], pair.p[other]);
            (swapped.u[k], swapped.rate[k]) = (pair.u[other], pair.rate[other]);
        });
        let [b, a] = rule(&swapped)?;
        Some(difference(rule(pair)?, [a, b]))
    }),
    ("p → −p of one rod", |rule, pair| {
        let mut turned = *pair;
        (turned.p[0], turned.rate[0]) = (-pair.p[0], -pair.rate[0]);
        let [minus_a, b] = rule(&turned)?;
        Some(difference(rule(pair)?, [-minus_a, b]))
    }),
    ("a rotated frame", |rule, pair| {
        let q = Rotation3::from_euler_angles(0.3, -1.1, 2.0);
        let turned = changed(pair, |pair, k| {
            pair.x[k] = q * pair.x[k];
            pair.p[k] = q * pair.p[k];
            pair.u[k] = q * pair.u[k];
            pair.rate[k] = q * pair.rate[k];
        });
        Some(difference(rule(pair)?.map(|rate| q * rate), rule(&turned)?))
    }),
    ("a Galilean shift of place and velocity", |rule, pair| {
        let moved = changed(pair, |pair, k| {
            pair.x[k] += Vector3::new(1.0, -2.0, 0.5);
            pair.u[k] += Vector3::new(-0.7, 0.2, 1.1);
        });
        Some(difference(rule(pair)?, rule(&moved)?))
    }),
    ("lengths in another unit", |rule, pair| {
        let scaled = changed(pair, |pair, k| {
            pair.x[k] *= 8.0;
            pair.u[k] *= 8.0;
        });
        Some(difference(rule(pair)?, rule(&scaled)?))
    }),
    ("applied twice = once", |rule, pair| {
        let once = rule(pair)?;
        Some(difference(once, rule(&Pair { rate: once, ..*pair })?))
    }),
    ("rods in the shear plane unaffected", |rule, pair| {
        // Both directions projected into the plane of axes 1 and 2, with rates in it; the flow is along axis 2.
        let flat = changed(pair, |pair, k| {
            let (phi, _) = orientation::angles(&pair.p[k]);
            pair.p[k] = orientation::from_angles(phi, FRAC_PI_2);
            pair.p[k].as_mut_unchecked().z = 0.0;
            pair.rate[k] = Vector3::new(-phi.sin(), phi.cos(), 0.0) * pair.rate[k].norm();
            pair.u[k] = Vector3::new(0.0, pair.x[k].x, 0.0);
        });
        if flat.p[0].cross(&flat.p[1]).norm() < 0.1 {
            return Some(0.0);
        }
        Some(difference(rule(&flat)?, flat.rate))
    }),
];
