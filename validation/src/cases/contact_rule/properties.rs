//! The invariants of the contact rule, each with its violation.

use super::*;

type Property = fn(ContactRule, &Pair) -> Option<f64>;

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
        let swapped = Pair {
            x: [pair.x[1], pair.x[0]],
            p: [pair.p[1], pair.p[0]],
            u: [pair.u[1], pair.u[0]],
            rate: [pair.rate[1], pair.rate[0]],
        };
        let ([a, b], [b2, a2]) = (rule(pair)?, rule(&swapped)?);
        Some((a - a2).norm() + (b - b2).norm())
    }),
    ("p → −p of one rod", |rule, pair| {
        let mut turned = *pair;
        (turned.p[0], turned.rate[0]) = (-pair.p[0], -pair.rate[0]);
        let ([a, b], [minus_a, b2]) = (rule(pair)?, rule(&turned)?);
        Some((a + minus_a).norm() + (b - b2).norm())
    }),
    ("a rotated frame", |rule, pair| {
        let q = Rotation3::from_euler_angles(0.3, -1.1, 2.0);
        let mut turned = *pair;
        for k in 0..2 {
            turned.x[k] = q * pair.x[k];
            turned.p[k] = q * pair.p[k];
            turned.u[k] = q * pair.u[k];
            turned.rate[k] = q * pair.rate[k];
        }
        let (before, after) = (rule(pair)?, rule(&turned)?);
        Some((q * before[0] - after[0]).norm() + (q * before[1] - after[1]).norm())
    }),
    ("a Galilean shift of place and velocity", |rule, pair| {
        let mut moved = *pair;
        for k in 0..2 {
            moved.x[k] += Vector3::new(1.0, -2.0, 0.5);
            moved.u[k] += Vector3::new(-0.7, 0.2, 1.1);
        }
        let (before, after) = (rule(pair)?, rule(&moved)?);
        Some((before[0] - after[0]).norm() + (before[1] - after[1]).norm())
    }),
    ("lengths in another unit", |rule, pair| {
        let mut scaled = *pair;
        for k in 0..2 {
            scaled.x[k] *= 8.0;
            scaled.u[k] *= 8.0;
        }
        let (before, after) = (rule(pair)?, rule(&scaled)?);
        Some((before[0] - after[0]).norm() + (before[1] - after[1]).norm())
    }),
    ("applied twice = once", |rule, pair| {
        let once = rule(pair)?;
        let twice = rule(&Pair { rate: once, ..*pair })?;
        Some((once[0] - twice[0]).norm() + (once[1] - twice[1]).norm())
    }),
    ("rods in the shear plane unaffected", |rule, pair| {
        // Both directions projected into the plane of axes 1 and 2, with rates in it; the flow is along axis 2.
        let mut flat = *pair;
        for k in 0..2 {
            let (phi, _) = orientation::angles(&pair.p[k]);
            flat.p[k] = orientation::from_angles(phi, FRAC_PI_2);
            flat.p[k].as_mut_unchecked().z = 0.0;
            flat.rate[k] = Vector3::new(-phi.sin(), phi.cos(), 0.0) * pair.rate[k].norm();
            flat.u[k] = Vector3::new(0.0, flat.x[k].x, 0.0);
        }
        if flat.p[0].cross(&flat.p[1]).norm() < 0.1 {
            return Some(0.0);
        }
        let after = rule(&flat)?;
        Some((after[0] - flat.rate[0]).norm() + (after[1] - flat.rate[1]).norm())
    }),
];
