//! The boxes of all texts of a picture, for tests. Widths are those of the widest font that a browser falls back to.

use super::style::FINE;
use super::texts::text_width;

#[derive(Clone, Debug)]
pub(crate) struct TextBox {
    pub(super) text: String,
    pub(super) left: f64,
    pub(super) right: f64,
    pub(super) top: f64,
    pub(super) bottom: f64,
}

fn attribute<'a>(tag: &'a str, name: &str) -> Option<&'a str> {
    let (_, rest) = tag.split_once(&format!(" {name}=\""))?;
    rest.split('"').next()
}

fn number(tag: &str, name: &str) -> f64 {
    attribute(tag, name).and_then(|text| text.parse().ok()).unwrap_or(0.0)
}

pub(super) fn boxes(svg: &str) -> Vec<TextBox> {
    let of = |part: &str| {
        let (tag, rest) = part.split_once('>')?;
        let text = rest.split("</text>").next()?.trim();
        // Without the tags of subscripts, which are a little narrower.
        let text: String = text.split('<').map(|part| part.split_once('>').map_or(part, |(_, text)| text)).collect();
        let text = text.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
        let (x, y, size) = (number(tag, "x"), number(tag, "y"), number(tag, "font-size"));
        let width = f64::from(text_width(&text, (size / f64::from(FINE)).round()));
        // Letters extend from 0.76 of their size above the line to a quarter below.
        let down = match attribute(tag, "dy") {
            Some("0.76em") => 0.76 * size,
            Some("0.5ex") => 0.27 * size,
            _ => 0.0,
        };
        let start = match attribute(tag, "text-anchor") {
            Some("middle") => -0.5 * width,
            Some("end") => -width,
            _ => 0.0,
        };
        let (along, across) = ((start, start + width), (down - 0.76 * size, down + 0.22 * size));
        let turned = attribute(tag, "transform").is_some_and(|t| t.contains("rotate"));
        // Rotated by 270 degrees, the text runs upwards.
        let (left, right, top, bottom) = if turned {
            (x + across.0, x + across.1, y - along.1, y - along.0)
        } else {
            (x + along.0, x + along.1, y + across.0, y + across.1)
        };
        Some(TextBox { text, left, right, top, bottom })
    };
    svg.split("<text").skip(1).filter_map(of).collect()
}

/// Messages on texts that leave the view box and on texts that overlap.
pub(crate) fn faults(svg: &str) -> Vec<String> {
    let view: Vec<f64> = (attribute(svg, "viewBox").unwrap_or_default().split(' '))
        .map(|number| number.parse().unwrap_or(0.0))
        .collect();
    let boxes = boxes(svg);
    let outside =
        boxes.iter().filter(|b| b.left < -1.0 || b.top < -1.0 || b.right > view[2] + 1.0 || b.bottom > view[3] + 1.0);
    let mut faults: Vec<_> = outside.map(|b| format!("outside: {b:?} of {view:?}")).collect();
    for (k, a) in boxes.iter().enumerate() {
        for b in &boxes[k + 1..] {
            let across = a.right.min(b.right) - a.left.max(b.left);
            let down = a.bottom.min(b.bottom) - a.top.max(b.top);
            if across > 1.0 && down > 1.0 && !a.text.is_empty() && !b.text.is_empty() {
                faults.push(format!("overlap: {a:?} and {b:?}"));
            }
        }
    }
    faults
}
