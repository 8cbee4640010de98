//! Clips curves and areas to the axes.

type Point = (f64, f64);

/// The distance from a line that nobody sees, in widths or heights of the frame: a quarter of a pixel of 500.
const UNSEEN: f64 = 1.0 / 2000.0;

/// The ranges of both axes, in placed values.
pub(super) struct Window {
    pub(super) x: (f64, f64),
    pub(super) y: (f64, f64),
}

impl Window {
    /// True if a point is inside or on the frame.
    pub(super) fn has(&self, (x, y): Point) -> bool {
        (self.x.0..=self.x.1).contains(&x) && (self.y.0..=self.y.1).contains(&y)
    }

    /// The distance of a point from each side of the frame, positive inside.
    fn depths(&self, (x, y): Point) -> [f64; 4] {
        [x - self.x.0, self.x.1 - x, y - self.y.0, self.y.1 - y]
    }

    /// A line through fewer points, from which those left out are nowhere farther than [`UNSEEN`] of the frame (Douglas
    /// & Peucker 1973).
    pub(super) fn thinned(&self, points: impl Iterator<Item = Point>) -> Vec<Point> {
        let points: Vec<Point> = points.collect();
        let scaled = |k: usize| (points[k].0 / (self.x.1 - self.x.0), points[k].1 / (self.y.1 - self.y.0));
        let far = |k: usize, first: usize, last: usize| {
            let ((x, y), (from, to)) = (scaled(k), (scaled(first), scaled(last)));
            let along = (to.0 - from.0, to.1 - from.1);
            let square = along.0 * along.0 + along.1 * along.1;
            let share = ((x - from.0) * along.0 + (y - from.1) * along.1) / square.max(f64::MIN_POSITIVE);
            let near = between(from, to, share.clamp(0.0, 1.0));
            (x - near.0).hypot(y - near.1)
        };
        let mut kept = vec![false; points.len()];
        let mut parts = Vec::new();
        if let Some(last) = points.len().checked_sub(1) {
            [kept[0], kept[last]] = [true; 2];
            parts.push((0, last));
        }
        while let Some((first, last)) = parts.pop() {
            let inner = (first + 1..last).map(|k| (k, far(k, first, last)));
            if let Some((k, _)) = inner.max_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, far)| *far > UNSEEN) {
                kept[k] = true;
                parts.extend([(first, k), (k, last)]);
            }
        }
        points.into_iter().zip(kept).filter(|(_, kept)| *kept).map(|(point, _)| point).collect()
    }

    /// The parts of a line that are inside (Liang & Barsky 1984).
    pub(super) fn lines(&self, points: Vec<Point>) -> Vec<Vec<Point>> {
        let mut parts: Vec<Vec<Point>> = Vec::new();
        let mut goes_on = false;
        for ends in points.windows(2) {
            let (from, to) = (self.depths(ends[0]), self.depths(ends[1]));
            let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
            for (from, to) in from.into_iter().zip(to) {
                match (from < 0.0, to < 0.0) {
                    (true, true) => leave = -1.0,
                    (true, false) => enter = enter.max(from / (from - to)),
                    (false, true) => leave = leave.min(from / (from - to)),
                    (false, false) => {}
                }
            }
            if enter > leave {
                goes_on = false;
                continue;
            }
            if !goes_on {
                parts.push(vec![between(ends[0], ends[1], enter)]);
            }
            if let Some(part) = parts.last_mut() {
                part.push(between(ends[0], ends[1], leave));
            }
            goes_on = leave == 1.0;
        }
        parts
    }

    /// The part of an area inside (Sutherland & Hodgman 1974), by its outline.
    pub(super) fn area(&self, outline: Vec<Point>) -> Vec<Point> {
        (0..4).fold(outline, |outline, side| {
            let depth = |point: Point| self.depths(point)[side];
            let mut inside = Vec::new();
            for (k, point) in outline.iter().enumerate() {
                let before = outline[(k + outline.len() - 1) % outline.len()];
                let (from, to) = (depth(before), depth(*point));
                if (from < 0.0) != (to < 0.0) {
                    inside.push(between(before, *point, from / (from - to)));
                }
                if to >= 0.0 {
                    inside.push(*point);
                }
            }
            inside
        })
    }
}

/// The point at `share` between `a` and `b`; exactly the ends at 0 and 1.
fn between(a: Point, b: Point, share: f64) -> Point {
    match share {
        0.0 => a,
        1.0 => b,
        _ => (a.0 + share * (b.0 - a.0), a.1 + share * (b.1 - a.1)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    const SQUARE: Window = Window { x: (0.0, 1.0), y: (0.0, 1.0) };

    #[test]
    fn a_line_is_cut_where_it_meets_the_frame() {
        let lines = |points: &[Point]| SQUARE.lines(points.to_vec());
        // In and out twice, by hand.
        let zigzag = [(-1.0, 0.5), (0.5, 0.5), (0.5, 2.0), (0.75, 2.0), (0.75, 0.5), (0.9, 0.5)];
        let expected = vec![vec![(0.0, 0.5), (0.5, 0.5), (0.5, 1.0)], vec![(0.75, 1.0), (0.75, 0.5), (0.9, 0.5)]];
        assert_eq!(lines(&zigzag), expected);
        // Across a corner from outside to outside, and past the corner.
        assert_eq!(lines(&[(-0.5, 1.0), (0.5, 0.0)]), vec![vec![(0.0, 0.5), (0.5, 0.0)]]);
        assert!(lines(&[(-0.5, 0.25), (0.25, -0.5)]).is_empty());
        // A line inside is unchanged.
        let inside = vec![(0.1, 0.3), (0.7, 0.9), (1.0, 0.0)];
        assert_eq!(lines(&inside), vec![inside]);
    }

    /// Of points on lines only the corners are left; of a circle, chords as near to it as nobody sees.
    #[test]
    fn points_on_a_line_are_left_out() {
        let thinned = |points: &[Point]| SQUARE.thinned(points.iter().copied());
        let corners = [(0.0, 0.0), (0.5, 1.0), (1.0, 0.0)];
        let on_lines = |k: usize| between(corners[k / 10], corners[(k / 10 + 1).min(2)], (k % 10) as f64 / 10.0);
        assert_eq!(thinned(&(0..=20).map(on_lines).collect::<Vec<_>>()), corners);
        assert_eq!([thinned(&[]).len(), thinned(&corners[..1]).len()], [0, 1]);
        let circle: Vec<Point> = (0..=10_000).map(|k| (TAU * f64::from(k) / 1e4).sin_cos()).collect();
        let few = thinned(&circle);
        // A chord over an angle a is (a/2)²/2 from the circle at most.
        let widest = few.windows(2).map(|ends| (ends[1].0 - ends[0].0).hypot(ends[1].1 - ends[0].1));
        assert!((99..220).contains(&few.len()), "{}", few.len());
        assert!(shearbed_oracle::worst(widest.map(|chord| chord * chord / 8.0)) <= UNSEEN * 1.001);
    }

    #[test]
    fn an_area_keeps_what_is_inside() {
        let size = |outline: &[Point]| {
            let cross = |k: usize| {
                let (a, b) = (outline[k], outline[(k + 1) % outline.len()]);
                a.0 * b.1 - a.1 * b.0
            };
            0.5 * (0..outline.len()).map(cross).sum::<f64>().abs()
        };
        // A diamond of area 2 about (0.5, 0.5) whose corners stand out: the whole square is inside it.
        let diamond = vec![(0.5, -0.5), (1.5, 0.5), (0.5, 1.5), (-0.5, 0.5)];
        assert_eq!(size(&diamond), 2.0);
        assert!((size(&SQUARE.area(diamond)) - 1.0).abs() < 1e-12);
        // Half of a rectangle; nothing of one beside the frame.
        let tall = vec![(0.25, 0.5), (0.75, 0.5), (0.75, 1.5), (0.25, 1.5)];
        assert!((size(&SQUARE.area(tall.clone())) - 0.25).abs() < 1e-12);
        assert!(SQUARE.area(tall.iter().map(|(x, y)| (x + 2.0, *y)).collect()).is_empty());
    }
}
