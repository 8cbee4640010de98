//! Coefficients of explicit Runge–Kutta methods: name, order, the rows of a below the diagonal, and b.

/// An explicit Runge–Kutta method.
#[derive(Clone)]
pub struct Tableau {
    /// Name of the method.
    pub name: &'static str,
    /// Order of the method.
    pub order: u32,
    /// Weights of the earlier stages in each stage, row by row.
    pub a: Vec<Vec<f64>>,
    /// Weights of the stages in the step.
    pub b: Vec<f64>,
}

fn tableau(name: &'static str, order: u32, a: &[&[f64]], b: &[f64]) -> Tableau {
    let rows = std::iter::once(Vec::new()).chain(a.iter().map(|row| row.to_vec())).collect();
    Tableau { name, order, a: rows, b: b.to_vec() }
}

/// Methods of orders 1 to 8.
#[rustfmt::skip]
pub fn all() -> Vec<Tableau> {
    let s = 21f64.sqrt();
    let r = 2f64.sqrt();
    vec![
        tableau("Euler", 1, &[], &[1.0]),
        tableau("midpoint", 2, &[&[0.5]], &[0.0, 1.0]),
        tableau("Heun 2", 2, &[&[1.0]], &[0.5, 0.5]),
        tableau("Ralston 2", 2, &[&[2.0 / 3.0]], &[0.25, 0.75]),
        tableau("Kutta 3", 3, &[&[0.5], &[-1.0, 2.0]], &[1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0]),
        tableau("Heun 3", 3, &[&[1.0 / 3.0], &[0.0, 2.0 / 3.0]], &[0.25, 0.0, 0.75]),
        tableau("Ralston 3", 3, &[&[0.5], &[0.0, 0.75]], &[2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0]),
        tableau("Shu-Osher 3", 3, &[&[1.0], &[0.25, 0.25]], &[1.0 / 6.0, 1.0 / 6.0, 2.0 / 3.0]),
        tableau("RK4", 4, &[&[0.5], &[0.0, 0.5], &[0.0, 0.0, 1.0]], &[1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0]),
        tableau("Kutta 3/8", 4, &[&[1.0 / 3.0], &[-1.0 / 3.0, 1.0], &[1.0, -1.0, 1.0]], &[0.125, 0.375, 0.375, 0.125]),
        tableau("Gill 4", 4, &[&[0.5], &[(r - 1.0) / 2.0, (2.0 - r) / 2.0], &[0.0, -r / 2.0, 1.0 + r / 2.0]],
            &[1.0 / 6.0, (2.0 - r) / 6.0, (2.0 + r) / 6.0, 1.0 / 6.0]),
        tableau("Butcher 5", 5, &[&[0.25], &[0.125, 0.125], &[0.0, -0.5, 1.0], &[3.0 / 16.0, 0.0, 0.0, 9.0 / 16.0],
            &[-3.0 / 7.0, 2.0 / 7.0, 12.0 / 7.0, -12.0 / 7.0, 8.0 / 7.0]],
            &[7.0 / 90.0, 0.0, 32.0 / 90.0, 12.0 / 90.0, 32.0 / 90.0, 7.0 / 90.0]),
        tableau("Cash-Karp 5", 5, &CASH_KARP, &[37.0 / 378.0, 0.0, 250.0 / 621.0, 125.0 / 594.0, 0.0, 512.0 / 1771.0]),
        tableau("Fehlberg \
            5", 5, &FEHLBERG, &[16.0 / 135.0, 0.0, 6656.0 / 12825.0, 28561.0 / 56430.0, -0.18, 2.0 / 55.0]),
        tableau("Dormand-Prince 5", 5, &DORMAND_PRINCE[..5],
            &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0]),
        tableau("Butcher 6", 6, &[&[1.0 / 3.0], &[0.0, 2.0 / 3.0], &[1.0 / 12.0, 1.0 / 3.0, -1.0 / 12.0],
            &[25.0 / 48.0, -55.0 / 24.0, 35.0 / 48.0, 15.0 / 8.0],
            &[0.15, -11.0 / 24.0, -0.125, 0.5, 0.1],
            &[-261.0 / 260.0, 33.0 / 13.0, 43.0 / 156.0, -118.0 / 39.0, 32.0 / 195.0, 80.0 / 39.0]],
            &[13.0 / 200.0, 0.0, 0.275, 0.275, 0.16, 0.16, 13.0 / 200.0]),
        tableau("Cooper-Verner 8", 8, &[&[0.5], &[0.25, 0.25],
            &[1.0 / 7.0, (-7.0 - 3.0 * s) / 98.0, (21.0 + 5.0 * s) / 49.0],
            &[(11.0 + s) / 84.0, 0.0, (18.0 + 4.0 * s) / 63.0, (21.0 - s) / 252.0],
            &[(5.0 + s) / 48.0, 0.0, (9.0 + s) / 36.0, (-231.0 + 14.0 * s) / 360.0, (63.0 - 7.0 * s) / 80.0],
            &[(10.0 - s) / 42.0, 0.0, (-432.0 + 92.0 * s) / 315.0, (633.0 - 145.0 * s) / 90.0,
                (-504.0 + 115.0 * s) / 70.0,
                (63.0 - 13.0 * s) / 35.0],
            &[1.0 / 14.0, 0.0, 0.0, 0.0, (14.0 - 3.0 * s) / 126.0, (13.0 - 3.0 * s) / 63.0, 1.0 / 9.0],
            &[1.0 / 32.0, 0.0, 0.0, 0.0, (91.0 - 21.0 * s) / 576.0, 11.0 / 72.0, (-385.0 - 75.0 * s) / 1152.0,
                (63.0 + 13.0 * s) / 128.0],
            &[1.0 / 14.0, 0.0, 0.0, 0.0, 1.0 / 9.0, (-733.0 - 147.0 * s) / 2205.0, (515.0 + 111.0 * s) / 504.0,
                (-51.0 - 11.0 * s) / 56.0, (132.0 + 28.0 * s) / 245.0],
            &[0.0, 0.0, 0.0, 0.0, (-42.0 + 7.0 * s) / 18.0, (-18.0 + 28.0 * s) / 45.0, (-273.0 - 53.0 * s) / 72.0,
                (301.0 + 53.0 * s) / 72.0, (28.0 - 28.0 * s) / 45.0, (49.0 - 7.0 * s) / 18.0]],
            &[0.05, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 49.0 / 180.0, 16.0 / 45.0, 49.0 / 180.0, 0.05]),
        extrapolated_euler("extrapolated Euler 7", 7),
        extrapolated("extrapolated midpoint 6", &[2, 4, 6], true),
        extrapolated("extrapolated midpoint 8", &[2, 4, 6, 8], true),
    ]
}

#[rustfmt::skip]
const CASH_KARP: [&[f64]; 5] = [&[0.2], &[3.0 / 40.0, 9.0 / 40.0], &[0.3, -0.9, 1.2], &[-11.0 / 54.0, 2.5,
    -70.0 / 27.0, 35.0 / 27.0],
    &[1631.0 / 55296.0, 175.0 / 512.0, 575.0 / 13824.0, 44275.0 / 110592.0, 253.0 / 4096.0]];
#[rustfmt::skip]
const FEHLBERG: [&[f64]; 5] = [&[0.25], &[3.0 / 32.0, 9.0 / 32.0], &[1932.0 / 2197.0, -7200.0 / 2197.0,
    7296.0 / 2197.0],
    &[439.0 / 216.0, -8.0, 3680.0 / 513.0, -845.0 / 4104.0],
    &[-8.0 / 27.0, 2.0, -3544.0 / 2565.0, 1859.0 / 4104.0, -11.0 / 40.0]];
#[rustfmt::skip]
const DORMAND_PRINCE: [&[f64]; 6] = [&[0.2], &[3.0 / 40.0, 9.0 / 40.0], &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0]];

/// Embedded pairs: the method that is continued, and b of the method for its error estimate.
#[rustfmt::skip]
pub fn pairs() -> Vec<(Tableau, Vec<f64>)> {
    vec![
        (tableau("Bogacki-Shampine 3(2)", 3, &[&[0.5], &[0.0, 0.75], &[2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0]],
            &[2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0, 0.0]), vec![7.0 / 24.0, 0.25, 1.0 / 3.0, 0.125]),
        (tableau("Fehlberg \
            5(4)", 5, &FEHLBERG, &[16.0 / 135.0, 0.0, 6656.0 / 12825.0, 28561.0 / 56430.0, -0.18, 2.0 / 55.0]),
            vec![25.0 / 216.0, 0.0, 1408.0 / 2565.0, 2197.0 / 4104.0, -0.2, 0.0]),
        (tableau("Cash-Karp \
            5(4)", 5, &CASH_KARP, &[37.0 / 378.0, 0.0, 250.0 / 621.0, 125.0 / 594.0, 0.0, 512.0 / 1771.0]),
            vec![2825.0 / 27648.0, 0.0, 18575.0 / 48384.0, 13525.0 / 55296.0, 277.0 / 14336.0, 0.25]),
        (tableau("Dormand-Prince 5(4)", 5, &DORMAND_PRINCE,
            &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0, 0.0]),
            vec![5179.0 / 57600.0, 0.0, 7571.0 / 16695.0, 393.0 / 640.0, -92097.0 / 339200.0, 187.0 / 2100.0, 0.025]),
    ]
}

/// Euler's method extrapolated from 1, 2, … substeps (Aitken & Neville; Hairer, Nørsett & Wanner, Solving Ordinary
/// Differential Equations I, II.9), of order `order`.
pub fn extrapolated_euler(name: &'static str, order: usize) -> Tableau {
    extrapolated(name, &(1..=order).collect::<Vec<_>>(), false)
}

/// Polynomial extrapolation of Euler's steps (its order is the number of entries in `substeps`), or of Gragg's midpoint
/// rule (twice that), as a tableau.
fn extrapolated(name: &'static str, substeps: &[usize], midpoint: bool) -> Tableau {
    let power = if midpoint { 2 } else { 1 };
    let weight = |j: usize| -> f64 {
        let n = |k: usize| (substeps[k] as f64).powi(power);
        (0..substeps.len()).filter(|k| *k != j).map(|k| n(j) / (n(j) - n(k))).product()
    };
    let stages = 1 + substeps.iter().map(|n| n - 1).sum::<usize>();
    let (mut a, mut b) = (vec![Vec::new()], vec![0.0; stages]);
    for (j, n) in substeps.iter().enumerate() {
        let h = 1.0 / *n as f64;
        // The weights of the stages in y_0, y_1, ..., y_n; the first stage is shared, the others are added one by one.
        let mut y = vec![vec![0.0; stages], vec![0.0; stages]];
        y[1][0] = h;
        for k in 1..*n {
            a.push(y[k].clone());
            let stage = a.len() - 1;
            let (mut next, step) = if midpoint { (y[k - 1].clone(), 2.0 * h) } else { (y[k].clone(), h) };
            next[stage] += step;
            y.push(next);
        }
        (0..stages).for_each(|i| b[i] += weight(j) * y[*n][i]);
    }
    for (stage, row) in a.iter_mut().enumerate() {
        row.truncate(stage);
    }
    Tableau { name, order: power as u32 * substeps.len() as u32, a, b }
}
