//! The observables that a scene can name.

use super::{Block, Channel, Observe, Sum};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::ops::Deref;

/// A built-in observable, as its module declares it: the values of [`Observe`]'s methods.
pub(super) struct Mean {
    pub name: &'static str,
    pub label: &'static str,
    pub columns: &'static [&'static str],
    /// Of the first columns; the others have their names.
    pub symbols: &'static [&'static str],
    pub range: fn(usize) -> [f64; 2],
    pub add: fn(&Block, &mut [Sum]),
    pub needs_couette: bool,
    pub needs_viscosity: bool,
    pub weighs_rods: bool,
    pub is_density: bool,
    /// A tensor's name, and its trace summed over all rods.
    pub trace: Option<(&'static str, Trace)>,
}

type Trace = fn(&[Sum]) -> f64;

impl Mean {
    /// A mean of any range in any flow; what every mean gives itself is empty.
    pub const ANY: Self = Self {
        name: "",
        label: "",
        columns: &[],
        symbols: &[],
        range: |_| [f64::NEG_INFINITY, f64::INFINITY],
        add: |_, _| (),
        needs_couette: false,
        needs_viscosity: false,
        weighs_rods: false,
        is_density: false,
        trace: None,
    };
}

impl Observe for Mean {
    fn name(&self) -> &'static str {
        self.name
    }
    fn label(&self) -> &'static str {
        self.label
    }
    fn columns(&self) -> &[&'static str] {
        self.columns
    }
    fn symbol(&self, column: usize) -> String {
        self.symbols.get(column).unwrap_or(&self.columns[column]).to_string()
    }
    fn range(&self, column: usize) -> [f64; 2] {
        (self.range)(column)
    }
    fn add(&self, block: &Block, sums: &mut [Sum]) {
        (self.add)(block, sums)
    }
    fn needs_couette(&self) -> bool {
        self.needs_couette
    }
    fn needs_viscosity(&self) -> bool {
        self.needs_viscosity
    }
    fn weighs_rods(&self) -> bool {
        self.weighs_rods
    }
    fn is_density(&self) -> bool {
        self.is_density
    }
    fn trace(&self, sums: &[Sum]) -> Option<(&'static str, f64)> {
        self.trace.map(|(tensor, sum)| (tensor, sum(sums)))
    }
}

macro_rules! observables {
    ($($(#[$doc:meta])* $variant:ident: $module:ident,)*) => {
        /// An observable, described by its [`Observe`]. Each has its own file of results, named like its key.
        ///
        /// ```
        /// use shearbed::Observable;
        /// let names: Vec<_> = Observable::Projections.channels().map(|channel| channel.name()).collect();
        /// assert_eq!(names, ["x1", "x2", "x3"]);
        /// ```
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[non_exhaustive]
        pub enum Observable {
            $($(#[$doc])* $variant,)*
        }

        impl Observable {
            /// Every observable.
            pub const ALL: [Self; [$(stringify!($variant)),*].len()] = [$(Self::$variant),*];
        }

        impl Deref for Observable {
            type Target = dyn Observe;

            fn deref(&self) -> &Self::Target {
                match self {
                    $(Self::$variant => &super::$module::MEAN,)*
                }
            }
        }
    };
}

observables! {
    /// Means of |p_i| (eq. 4).
    Projections: projections,
    /// Mean projections on planes (eq. 21).
    PlanarProjections: planar_projections,
    /// The mean of φ folded into [0, π/2] (eq. 18), in radians.
    MeanAngle: mean_angle,
    /// ⟨cos 2φ⟩.
    Cos2Phi: cos_2phi,
    /// Mean and density of C_b = C/(1 + C) (eq. 13).
    OrbitConstant: orbit_constant,
    /// ⟨pp⟩.
    OrientationTensor: orientation_tensor,
    /// ⟨pppp⟩: its 15 components that differ.
    OrientationTensor4: orientation_tensor_4,
    /// The stress of dilute slender rods in plane Couette flow.
    ParticleStress: particle_stress,
    /// The stress of dilute rods of their own shape in plane Couette flow, in Pa.
    Stress: stress,
}

impl Observable {
    /// The channels of this observable, in the order of its columns.
    pub fn channels(self) -> impl Iterator<Item = Channel> {
        (0..self.width()).map(move |index| Channel::new(self, index))
    }

    /// Number of channels.
    pub fn width(self) -> usize {
        self.columns().len()
    }
}

impl Serialize for Observable {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl<'de> Deserialize<'de> for Observable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        let found = Self::ALL.into_iter().find(|observable| observable.name() == name);
        found.ok_or_else(|| serde::de::Error::custom(format!("there is no observable {name:?}")))
    }
}
