//! Symbols and units of the program's columns and keys, for axes and legends.

use shearbed::observable::Channel;

/// The symbol of a column of `shearbed run`, such as `X̄₁` for `x1`, also of what is derived from it; the name of any
/// other column.
pub fn channel(column: &str) -> String {
    let symbol = |column| Channel::named(column).map(Channel::symbol);
    let derived = || {
        let ends = |kind: &str| symbol(column.strip_suffix(kind)?);
        let word = |kind| Some(format!("{kind} of {}", ends(&format!("_{kind}"))?));
        let rate = ends("_damping_rate").map(|symbol| format!("damping rate λ of {symbol}"));
        let steady = ends("_steady").map(|symbol| format!("steady {symbol}"));
        ["amplitude", "maximum", "minimum"].into_iter().find_map(word).or(rate).or(steady)
    };
    symbol(column).or_else(derived).unwrap_or_else(|| column.to_owned())
}

/// The label of a column of times.
pub fn time(column: &str) -> String {
    match column {
        "t_over_T" => "t/T",
        "t_s" | "time_s" => "t (s)",
        "strain" => "strain Gt",
        other => other,
    }
    .to_owned()
}

/// The symbol and the unit of a key; the last word of a key without a symbol.
fn letter(key: &str) -> (&str, &'static str) {
    match key {
        "interaction.alpha" => ("α", ""),
        "interaction.m" => ("m", ""),
        "interaction.concentration_per_cm3" => ("n", "cm⁻³"),
        "particles.aspect_ratio" => ("r_e", ""),
        "particles.aspect_ratio_sd_percent" => ("spread of r_e", "%"),
        "particles.volume_fraction" => ("volume fraction", ""),
        "particles.count" => ("N", ""),
        "particles.length_mm" => ("a", "mm"),
        "flow.shear_rate_per_s" => ("G", "s⁻¹"),
        other => (other.rsplit('.').next().unwrap_or(other), ""),
    }
}

/// The label of a key on an axis, with its unit: `n (cm⁻³)`. `2:KEY` is the key of the second set; `KEY*KEY^(1/3)` is a
/// product.
pub fn key(label: &str) -> String {
    let (set, key) = label.split_once(':').map_or((None, label), |(set, key)| (Some(set), key));
    let factor = |factor: &str| {
        let (key, power) = factor.split_at(factor.find('^').unwrap_or(factor.len()));
        format!("{}{power}", letter(key).0)
    };
    let letters: Vec<_> = key.split('*').map(factor).collect();
    let units: Vec<_> = key.split('*').map(unit).filter(|unit| !unit.is_empty()).collect();
    let of = set.map_or(String::new(), |set| format!(" of set {set}"));
    let unit = if units.is_empty() { String::new() } else { format!(" ({})", units.join(" ")) };
    format!("{}{of}{unit}", letters.join(" "))
}

/// The unit of a key, or of a power of one as `KEY^(1/3)`.
fn unit(factor: &str) -> String {
    let Some((key, power)) = factor.split_once('^') else { return letter(factor).1.to_owned() };
    let of_key = letter(key).1;
    match of_key.strip_suffix("⁻³") {
        Some(length) if power == "(1/3)" => format!("{length}⁻¹"),
        _ if of_key.is_empty() => String::new(),
        _ => format!("({of_key})^{power}"),
    }
}

/// A point of a sweep as `α = 0.5, n = 20 cm⁻³`.
pub fn point(pairs: &[(String, String)]) -> String {
    let label = |(key, value): &(String, String)| {
        let (letter, unit) = letter(key);
        format!("{letter} = {} {unit}", short(value)).trim_end().to_owned()
    };
    pairs.iter().map(label).collect::<Vec<_>>().join(", ")
}

/// A scene's title without the parts between commas that give the value of a swept key, as `n = 50 per cm³`.
pub fn title_without(title: &str, swept: &[&str]) -> String {
    let is_of = |part: &str, key: &str| {
        let own = letter(key).0;
        let letters = match key {
            // The paper's letter for the spread, in its captions.
            "particles.aspect_ratio_sd_percent" => ["σ", own],
            // Each gives n.
            "particles.volume_fraction" | "interaction.box_mm" => ["n", own],
            _ => [own; 2],
        };
        part.split_once('=').is_some_and(|(name, _)| letters.contains(&name.trim()))
    };
    let stays = |part: &&str| !swept.iter().any(|key| is_of(part, key));
    title.split(", ").filter(stays).collect::<Vec<_>>().join(", ")
}

/// A scene's title with the keys that replace its own: a part with the value of one gives way to the new value, and a
/// title set with them stays. Replicas, seed and outputs are no part of what is simulated, so that it leaves them out.
pub fn title_with(title: &str, pairs: &[(String, String)]) -> String {
    if pairs.iter().any(|(key, _)| key == "title") {
        return title.to_owned();
    }
    let is_said = |(key, _): &&(String, String)| !["ensemble.", "output"].iter().any(|unsaid| key.contains(unsaid));
    let said: Vec<_> = pairs.iter().filter(is_said).cloned().collect();
    let keys: Vec<&str> = said.iter().map(|(key, _)| key.as_str()).collect();
    let parts = [title_without(title, &keys), point(&said)];
    parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
}

/// A number with more than seven characters in four significant digits; anything else as it is.
pub fn short(value: &str) -> String {
    match value.parse::<f64>() {
        Ok(number) if value.len() > 7 => {
            let rounded = format!("{number:.3e}").parse::<f64>();
            rounded.map_or_else(|_| value.to_owned(), |rounded| rounded.to_string())
        }
        _ => value.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_and_keys_have_letters_and_units() {
        assert_eq!(["x1", "phi", "a12", "a1122", "x1x2"].map(channel), ["X̄₁", "φ̄ (rad)", "a_12", "a_1122", "x1x2"]);
        assert_eq!(
            ["cos_2phi", "s12_pa", "n1_per_mu_fiber_g", "n1_mm", "n9_pa"].map(channel),
            ["⟨cos 2φ⟩", "σ_12 (Pa)", "N_1/(μ_fiber G)", "n1_mm", "n9_pa"]
        );
        assert_eq!(
            ["x1_amplitude", "phi_minimum", "x1_damping_rate", "x1_steady", "x9_amplitude"].map(channel),
            ["amplitude of X̄₁", "minimum of φ̄ (rad)", "damping rate λ of X̄₁", "steady X̄₁", "x9_amplitude"]
        );
        assert_eq!(["t_over_T", "t_s", "strain"].map(time), ["t/T", "t (s)", "strain Gt"]);
        let keys = ["interaction.concentration_per_cm3", "2:interaction.alpha", "time.periods"];
        assert_eq!(keys.map(key), ["n (cm⁻³)", "α of set 2", "periods"]);
        let product = "interaction.alpha*particles.length_mm*interaction.concentration_per_cm3^(1/3)";
        assert_eq!(key(product), "α a n^(1/3) (mm cm⁻¹)");
        let owned = |pairs: &[(&str, &str)]| {
            pairs.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect::<Vec<_>>()
        };
        let point = |pairs: &[(&str, &str)]| point(&owned(pairs));
        let [alpha, n] = ["interaction.alpha", "interaction.concentration_per_cm3"];
        let orientation = ("particles.orientation", "{ phi_deg = 0.0, theta_deg = 90.0 }");
        assert_eq!(
            point(&[(alpha, "0.25"), (n, "20"), orientation]),
            "α = 0.25, n = 20 cm⁻³, orientation = { phi_deg = 0.0, theta_deg = 90.0 }"
        );
        assert_eq!(point(&[(alpha, "0.2727272727272727")]), "α = 0.2727");
        let title = |keys: &[&str]| title_without("Fig. 7, n = 50 per cm³, σ = 0 %", keys);
        assert_eq!(title(&[n, alpha]), "Fig. 7, σ = 0 %");
        assert_eq!(title(&["particles.aspect_ratio_sd_percent"]), "Fig. 7, n = 50 per cm³");
        assert_eq!([title(&[alpha]), title(&[])], ["Fig. 7, n = 50 per cm³, σ = 0 %"; 2]);
        let with = |pairs: &[(&str, &str)]| title_with("Fig. 7, n = 50 per cm³, σ = 0 %", &owned(pairs));
        assert_eq!(with(&[(n, "80"), (alpha, "0.9")]), "Fig. 7, σ = 0 %, n = 80 cm⁻³, α = 0.9");
        assert_eq!(
            with(&[("ensemble.replicas", "2"), ("time.outputs_per_period", "9")]),
            "Fig. 7, n = 50 per cm³, σ = 0 %"
        );
    }
}
