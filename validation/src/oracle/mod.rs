//! What judges the core: closed forms, quadratures and a naive reference. Nothing here uses the core.

pub mod closed_form;
pub mod exponential;
pub mod isotropic;
pub mod jeffery;
pub mod kicks;
pub mod moments;
pub mod naive;
pub mod pairing;
pub mod quadrature;
