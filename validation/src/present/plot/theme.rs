//! Light and dark: the same figure in different colours.

use plotters_backend::BackendColor;
use serde::{Deserialize, Serialize};

/// The background for which a figure is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Theme {
    /// Dark ink on white.
    #[default]
    Light,
    /// Light ink on a dark ground.
    Dark,
}

/// Share of its distance from white that a colour keeps on a dark background.
const KEPT: f64 = 0.7;

/// Grey level of the dark background, in place of white.
const GROUND: f64 = 24.0;

impl Theme {
    pub(super) fn of(self, color: BackendColor) -> BackendColor {
        BackendColor { rgb: self.rgb(color.rgb), ..color }
    }

    /// On a dark background greys are inverted and colours lightened: colours that differ still differ.
    fn rgb(self, (red, green, blue): (u8, u8, u8)) -> (u8, u8, u8) {
        let all = [red, green, blue];
        let spread = red.max(green).max(blue) - red.min(green).min(blue);
        let turned = |part: u8| 255.0 - (255.0 - GROUND) * f64::from(part) / 255.0;
        let lightened = |part: u8| 255.0 - KEPT * f64::from(255 - part);
        let part = |part: u8| if spread < 64 { turned(part) } else { lightened(part) };
        match self {
            Self::Light => (red, green, blue),
            Self::Dark => all.map(|value| part(value).round() as u8).into(),
        }
    }

    /// The SVG document in the colours of this theme. Colours are whole attributes there, and quotation marks in texts
    /// are escaped.
    pub(super) fn svg(self, drawing: String) -> String {
        if self == Self::Light {
            return drawing;
        }
        let mut parts = drawing.split("=\"#");
        let mut themed = parts.next().unwrap_or_default().to_owned();
        for part in parts {
            themed += "=\"#";
            let digits = |at: usize| u8::from_str_radix(part.get(at..at + 2)?, 16).ok();
            match (digits(0), digits(2), digits(4)) {
                (Some(red), Some(green), Some(blue)) => {
                    let (red, green, blue) = self.rgb((red, green, blue));
                    themed += &format!("{red:02X}{green:02X}{blue:02X}{}", &part[6..]);
                }
                _ => themed += part,
            }
        }
        themed
    }
}

#[cfg(test)]
mod tests {
    use super::super::style::{LEVELS, SHADES};
    use super::super::tests::synthetic;
    use super::super::{Figure, svg};
    use super::*;

    /// Relative luminance and contrast of WCAG 2.
    fn contrast(a: (u8, u8, u8), b: (u8, u8, u8)) -> f64 {
        let light = |(red, green, blue): (u8, u8, u8)| {
            let linear = |part: u8| {
                let part = f64::from(part) / 255.0;
                if part <= 0.04045 { part / 12.92 } else { ((part + 0.055) / 1.055).powf(2.4) }
            };
            0.2126 * linear(red) + 0.7152 * linear(green) + 0.0722 * linear(blue)
        };
        let (a, b) = (light(a), light(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn ink_and_every_colour_is_seen_on_a_dark_ground() {
        let ground = Theme::Dark.rgb((255, 255, 255));
        assert!(contrast(Theme::Dark.rgb((34, 34, 34)), ground) > 7.0);
        for look in (0..11).chain(SHADES..SHADES + LEVELS) {
            let color = super::super::style::colour(look);
            let color = (color.0, color.1, color.2);
            // WCAG requires 3 for graphics; control: a colour as it is on white may not reach it.
            assert!(contrast(Theme::Dark.rgb(color), ground) > 3.0, "{look}: {color:?}");
        }
        assert!(contrast((51, 34, 136), ground) < 3.0);
    }

    #[test]
    fn a_dark_picture_differs_in_colours_alone() {
        let light = svg(&synthetic()).unwrap();
        let dark = svg(&Figure { theme: Theme::Dark, ..synthetic() }).unwrap();
        let bare = |drawing: &str| {
            let parts = drawing.split("=\"#").enumerate();
            parts.map(|(k, part)| if k == 0 { part } else { &part[6..] }.to_owned()).collect::<String>()
        };
        assert_eq!(bare(&light), bare(&dark));
        // The background; black, as of a band in the legend, becomes white on it.
        assert!(!light.contains("#181818") && dark.contains("fill=\"#181818\""));
        // A text that looks like an attribute stays.
        let titled = Figure { title: "a=\"#FFFFFF\"".into(), theme: Theme::Dark, ..synthetic() };
        assert!(svg(&titled).unwrap().contains("a=&quot;#FFFFFF"));
    }
}
