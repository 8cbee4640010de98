//! A picture for a phone: narrow, so that its letters are legible without scrolling.

use super::style::FINE;
use super::{Figure, Parts, svg, typeset};

/// Width of the picture in pixels: a phone's, without the page's margins.
const WIDTH: u32 = 344;

/// Height in pixels that the axes have beyond the least.
const MORE: u32 = 80;

/// The figure as an SVG document for a phone; `None` for maps, which have no narrow form.
pub(crate) fn narrow(figure: &Figure) -> Result<Option<String>, String> {
    if figure.grid.is_some() {
        return Ok(None);
    }
    let sized = |height| Figure { size: Some((WIDTH, height)), ..figure.clone() };
    let least = Parts::of(&typeset(&sized(0))).height / FINE;
    svg(&sized(least as u32 + MORE)).map(Some)
}

#[cfg(test)]
mod tests {
    use super::super::boxes::faults;
    use super::super::tests::{fitted, many, maps, synthetic};
    use super::*;

    #[test]
    fn a_narrow_picture_has_large_letters_inside_and_apart() {
        for figure in [synthetic(), many(), fitted()] {
            let svg = narrow(&figure).unwrap().unwrap();
            assert!(faults(&svg).is_empty(), "{}: {:#?}", figure.title, faults(&svg));
            let sizes = svg.split("font-size=\"").skip(1).map(|rest| rest.split('"').next().unwrap());
            // Subscripts are per cent of their letters.
            let sizes: Vec<f64> = sizes.filter_map(|size| size.parse().ok()).collect();
            assert!(sizes.len() > 10 && sizes.iter().all(|size| *size >= 12.0 * f64::from(FINE)), "{sizes:?}");
        }
        assert!(narrow(&maps()).unwrap().is_none());
    }
}
