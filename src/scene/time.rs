//! `[time]`: a scene's duration, and its numbers of steps and outputs.

use super::keys::{Absent::Other, Holds, PER_UNIT, table};
use super::read::Reader;
use crate::motion::Span;
use serde::Serialize;

/// `[time]`: a duration in one unit, with steps and outputs per unit. By default one period.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(into = "TimeKeys")]
pub struct Time {
    /// The unit of the duration.
    pub unit: TimeUnit,
    /// The duration in that unit: the key `periods`, `strain` or `seconds`.
    pub duration: f64,
    /// Steps of interacting rods per unit (`steps_per_period` and so on); by default as many as resolve the motion.
    pub steps_per_unit: Option<u64>,
    /// Outputs per unit (`outputs_per_period` and so on); by default [`super::Scene::outputs_per_unit`].
    pub outputs_per_unit: Option<u64>,
}

/// The unit of a scene's time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TimeUnit {
    /// A period T of the mean aspect ratio.
    #[default]
    Period,
    /// A unit of shear strain ∫(2D:D)^½ dt.
    Strain,
    /// A second.
    Second,
}

impl TimeUnit {
    pub(super) const ALL: [Self; 3] = [Self::Period, Self::Strain, Self::Second];

    /// The span of `number`/`over` units.
    pub(crate) fn span(self, number: f64, over: f64) -> Span {
        match self {
            Self::Period => Span::Periods(number, over),
            Self::Strain => Span::Strain(number, over),
            Self::Second => Span::Seconds(number, over),
        }
    }

    /// The keys of the duration, of the steps and of the outputs.
    pub(super) const fn keys(self) -> [&'static str; 3] {
        match self {
            Self::Period => ["time.periods", "time.steps_per_period", "time.outputs_per_period"],
            Self::Strain => ["time.strain", "time.steps_per_strain", "time.outputs_per_strain"],
            Self::Second => ["time.seconds", "time.steps_per_second", "time.outputs_per_second"],
        }
    }

    /// The key of a duration in this unit.
    pub fn duration_key(self) -> &'static str {
        self.keys()[0]
    }

    /// The key of the steps per unit.
    pub fn steps_key(self) -> &'static str {
        self.keys()[1]
    }

    /// The key of the outputs per unit.
    pub(crate) fn outputs_key(self) -> &'static str {
        self.keys()[2]
    }
}

impl std::fmt::Display for TimeUnit {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Period => "period",
            Self::Strain => "unit of strain",
            Self::Second => "second",
        })
    }
}

impl Default for Time {
    fn default() -> Self {
        Self::periods(1.0)
    }
}

table! {
    /// The keys of `[time]`.
    pub(super) struct TimeKeys in "time" {
        periods: Option<f64> = None, "T", Holds::NotNegative, Other("strain or seconds"),
            "how long, in periods T of the mean aspect ratio";
        strain: Option<f64> = None, "", Holds::NotNegative, Other("periods or seconds"),
            "how long, in shear strain ∫(2D:D)^½ dt: for flows without a period";
        seconds: Option<f64> = None, "s", Holds::NotNegative, Other("periods or strain"),
            "how long, in seconds";
        steps_per_period: Option<u64> = None, "", PER_UNIT, Other("as many as resolve the motion"),
            "steps of interacting rods";
        steps_per_strain: Option<u64> = None, "", PER_UNIT, Other("as many as resolve the motion"),
            "steps of interacting rods per unit of strain";
        steps_per_second: Option<u64> = None, "", PER_UNIT, Other("as many as resolve the motion"),
            "steps of interacting rods per second";
        outputs_per_period: Option<u64> = None, "", PER_UNIT,
            Other("0.2 of strain apart, 0.4 if rods take steps"),
            "outputs; of interacting rods a divisor of the steps";
        outputs_per_strain: Option<u64> = None, "", PER_UNIT, Other("10, or the largest divisor below"),
            "outputs per unit of strain, likewise";
        outputs_per_second: Option<u64> = None, "", PER_UNIT,
            Other("10 a unit of strain, or the largest divisor below"),
            "outputs per second, likewise";
    }
}

impl TimeKeys {
    /// The keys of a unit: duration, steps and outputs per unit.
    fn of(&mut self, unit: TimeUnit) -> (&mut Option<f64>, &mut Option<u64>, &mut Option<u64>) {
        match unit {
            TimeUnit::Period => (&mut self.periods, &mut self.steps_per_period, &mut self.outputs_per_period),
            TimeUnit::Strain => (&mut self.strain, &mut self.steps_per_strain, &mut self.outputs_per_strain),
            TimeUnit::Second => (&mut self.seconds, &mut self.steps_per_second, &mut self.outputs_per_second),
        }
    }
}

impl From<Time> for TimeKeys {
    fn from(time: Time) -> Self {
        let mut keys = Self::default();
        let (duration, steps, outputs) = keys.of(time.unit);
        (*duration, *steps, *outputs) = (Some(time.duration), time.steps_per_unit, time.outputs_per_unit);
        keys
    }
}

impl Time {
    /// A duration in periods of the mean aspect ratio, with default steps and outputs.
    pub fn periods(duration: f64) -> Self {
        Self { unit: TimeUnit::Period, duration, steps_per_unit: None, outputs_per_unit: None }
    }

    /// A duration as a shear strain, with default steps and outputs.
    pub fn strain(duration: f64) -> Self {
        Self { unit: TimeUnit::Strain, ..Self::periods(duration) }
    }

    /// A duration in seconds, with default steps and outputs.
    pub fn seconds(duration: f64) -> Self {
        Self { unit: TimeUnit::Second, ..Self::periods(duration) }
    }

    pub(super) fn read(reader: &mut Reader<'_>) -> Option<Self> {
        let keys = TimeUnit::ALL.map(TimeUnit::duration_key);
        let given = reader.one_of(keys, "periods, strain or seconds must be given");
        let unit = TimeUnit::ALL.into_iter().find(|unit| Some(unit.duration_key()) == given);
        let others = TimeUnit::ALL.into_iter().filter(|other| unit.is_some_and(|unit| unit != *other));
        let keys = others.flat_map(|other| [TimeUnit::steps_key, TimeUnit::outputs_key].map(|key| (other, key)));
        if let Some((other, key)) = keys.into_iter().find(|(other, key)| reader.has(key(*other))) {
            let own = unit.unwrap_or_default();
            let [goes, given, takes] = [other.duration_key(), own.duration_key(), key(own)].map(name);
            let verb = if own == TimeUnit::Strain { "takes" } else { "take" };
            reader.refuse(key(other), &format!("goes with {goes}; {given} {verb} {takes}"));
        }
        let mut keys = TimeKeys::read_keys(reader)?;
        let unit = unit?;
        let (duration, steps_per_unit, outputs_per_unit) = keys.of(unit);
        let (steps_per_unit, outputs_per_unit) = (*steps_per_unit, *outputs_per_unit);
        Some(Self { unit, duration: (*duration)?, steps_per_unit, outputs_per_unit })
    }
}

/// A key without its table.
fn name(key: &'static str) -> &'static str {
    key.trim_start_matches("time.")
}
