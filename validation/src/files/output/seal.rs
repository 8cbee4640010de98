//! A mark in a picture with the checksum of what stands before it: whether somebody edited the picture since.

const MARK: &[u8] = b"shearbed crc32 ";
const DIGITS: usize = 8;
/// The end of a PNG file: its last chunk, which is always the same.
const IEND: usize = 12;
/// What may follow the checksum: in PNG the checksum of the chunk of text that it is in, and the last chunk.
const MOST_AFTER: usize = 4 + IEND;

/// An SVG, PDF or PNG picture with its mark: a comment at the end, in PNG a chunk of text.
pub fn sealed(mut picture: Vec<u8>) -> Vec<u8> {
    let text = |before: &[u8]| [MARK, format!("{:08x}", crc32fast::hash(before)).as_bytes()].concat();
    if picture.starts_with(b"\x89PNG") {
        let end = picture.split_off(picture.len().saturating_sub(IEND));
        let begun = b"tEXtComment\0";
        picture.extend(((begun.len() - 4 + MARK.len() + DIGITS) as u32).to_be_bytes());
        let chunk = picture.len();
        picture.extend(begun);
        picture.extend(text(&picture));
        picture.extend(crc32fast::hash(&picture[chunk..]).to_be_bytes());
        picture.extend(end);
    } else {
        let [before, after]: [&[u8]; 2] =
            if picture.starts_with(b"%PDF") { [b"%", b"\n"] } else { [b"<!--", b"-->\n"] };
        picture.extend(before);
        picture.extend(text(&picture));
        picture.extend(after);
    }
    picture
}

/// True if a picture is as [`sealed`] made it.
pub fn is_unedited(picture: &[u8]) -> bool {
    let place = picture.windows(MARK.len()).rposition(|window| window == MARK);
    place.is_some_and(|place| {
        let after = &picture[place + MARK.len()..];
        let sum = format!("{:08x}", crc32fast::hash(&picture[..place]));
        after.starts_with(sum.as_bytes()) && after.len() <= DIGITS + MOST_AFTER
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::present::plot::{self, Curve, Figure};

    #[test]
    fn a_picture_of_any_format_is_known_until_a_byte_of_it_changes() {
        let figure = Figure {
            curves: vec![Curve::of("a", [0.0, 1.0], |x| (x, x))],
            x_name: "x".into(),
            y_name: "y".into(),
            ..Figure::default()
        };
        let svg = plot::svg(&figure).unwrap().into_bytes();
        for bare in [svg, plot::pdf(&figure).unwrap().bytes, plot::png(&figure).unwrap().bytes] {
            let own = sealed(bare.clone());
            assert!(is_unedited(&own) && !is_unedited(&bare));
            for place in (0..own.len() - MOST_AFTER).step_by(own.len() / 50) {
                let mut edited = own.clone();
                edited[place] ^= 1;
                assert!(!is_unedited(&edited), "{place} of {}", own.len());
            }
            assert!(!is_unedited(&[&own[..], b"<!-- and more of it -->"].concat()));
            // It can still be drawn.
            if own.starts_with(b"\x89PNG") {
                assert!(png::Decoder::new(std::io::Cursor::new(&own)).read_info().unwrap().finish().is_ok());
            }
        }
    }
}
