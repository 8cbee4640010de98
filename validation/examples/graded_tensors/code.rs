//! A code for orientation tensors in plain arrays, each part of which can be made wrong. It shares nothing with the
//! project's own.

use std::array::from_fn;

pub type M = [[f64; 3]; 3];
pub type Closure = fn(&M, [usize; 4]) -> f64;

/// The parts of a code; [`Code::right`] has the right ones.
#[derive(Clone)]
pub struct Code {
    pub gradient: fn(&M) -> M,
    /// The ½ of W and of D.
    pub half: [f64; 2],
    pub shape: fn(f64) -> f64,
    /// γ̇ from L and D.
    pub speed: fn(&M, &M) -> f64,
    /// Before Da + aD, and before 𝔸:D, from Λ.
    pub stretch: [fn(f64) -> f64; 2],
    /// The 2 and the 3 of 2 C_I γ̇ (δ − 3a), and the 1 before δ.
    pub spread: [f64; 3],
    pub closure: Closure,
    /// What is written for 11, 22, 33, 12, 13, 23.
    pub written: fn([f64; 6]) -> [f64; 6],
}

fn sum(of: impl Fn(usize) -> f64) -> f64 {
    (0..3).map(of).sum()
}

pub fn double(a: &M, b: &M) -> f64 {
    sum(|i| sum(|j| a[i][j] * b[i][j]))
}

pub const fn delta(i: usize, j: usize) -> f64 {
    if i == j { 1.0 } else { 0.0 }
}

pub fn linear_by(a: &M, [i, j, k, l]: [usize; 4], seventh: f64, ones: f64) -> f64 {
    let d = delta;
    let of_a = a[i][j] * d(k, l) + a[i][k] * d(j, l) + a[i][l] * d(j, k);
    let of_others = a[k][l] * d(i, j) + a[j][l] * d(i, k) + a[j][k] * d(i, l);
    seventh * (of_a + of_others) + ones * (d(i, j) * d(k, l) + d(i, k) * d(j, l) + d(i, l) * d(j, k))
}

pub fn linear(a: &M, at: [usize; 4]) -> f64 {
    linear_by(a, at, 1.0 / 7.0, -1.0 / 35.0)
}

pub fn quadratic(a: &M, [i, j, k, l]: [usize; 4]) -> f64 {
    a[i][j] * a[k][l]
}

pub fn determinant(a: &M) -> f64 {
    sum(|j| a[0][j] * (a[1][(j + 1) % 3] * a[2][(j + 2) % 3] - a[1][(j + 2) % 3] * a[2][(j + 1) % 3]))
}

pub fn hybrid_by(a: &M, at: [usize; 4], f: f64) -> f64 {
    f * quadratic(a, at) + (1.0 - f) * linear(a, at)
}

pub fn hybrid(a: &M, at: [usize; 4]) -> f64 {
    hybrid_by(a, at, 1.0 - 27.0 * determinant(a))
}

impl Code {
    pub fn right(closure: Closure) -> Self {
        Self {
            gradient: |l| *l,
            half: [0.5, 0.5],
            shape: |r| 1.0 - 2.0 / (r * r + 1.0),
            speed: |_, d| (2.0 * double(d, d)).sqrt(),
            stretch: [|shape| shape, |shape| 2.0 * shape],
            spread: [2.0, 3.0, 1.0],
            closure,
            written: |six| six,
        }
    }

    /// da_ij/dt.
    pub fn rate(&self, a: &M, l: &M, r: f64, c_i: f64) -> M {
        let l = (self.gradient)(l);
        let w: M = from_fn(|i| from_fn(|j| self.half[0] * (l[i][j] - l[j][i])));
        let d: M = from_fn(|i| from_fn(|j| self.half[1] * (l[i][j] + l[j][i])));
        let shape = (self.shape)(r);
        let [strain, fourth] = self.stretch.map(|of| of(shape));
        let [two, three, one] = self.spread;
        let diffusion = two * c_i * (self.speed)(&l, &d);
        from_fn(|i| {
            from_fn(|j| {
                let turned = sum(|k| w[i][k] * a[k][j] - a[i][k] * w[k][j]);
                let stretched = sum(|k| d[i][k] * a[k][j] + a[i][k] * d[k][j]);
                let contracted = sum(|k| sum(|m| (self.closure)(a, [i, j, k, m]) * d[k][m]));
                turned + strain * stretched - fourth * contracted + diffusion * (one * delta(i, j) - three * a[i][j])
            })
        })
    }

    /// a_ij at the times, by RK4 in steps of `strain`.
    pub fn path(&self, start: &M, l: &M, r: f64, c_i: f64, times_s: &[f64], strain: f64) -> Vec<M> {
        let add = |a: &M, k: &M, h: f64| -> M { from_fn(|i| from_fn(|j| a[i][j] + h * k[i][j])) };
        let norm = double(l, l).sqrt();
        let (mut a, mut now) = (*start, 0.0);
        let to = |time: &f64| {
            let steps = ((time - now) * norm / strain).ceil();
            let h = (time - now) / steps;
            for _ in 0..steps as usize {
                let rate = |a: &M| self.rate(a, l, r, c_i);
                let k1 = rate(&a);
                let k2 = rate(&add(&a, &k1, h / 2.0));
                let k3 = rate(&add(&a, &k2, h / 2.0));
                let k4 = rate(&add(&a, &k3, h));
                for (k, part) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
                    a = add(&a, &k, h * part / 6.0);
                }
            }
            now = *time;
            a
        };
        times_s.iter().map(to).collect()
    }
}
