//! Footprints: the Jacobian against rays through neighbouring pixels, the textbook's values, what a fit predicts of
//! them, and the debug view for shaders against its twin and the exact function.

#[path = "../common/mod.rs"]
mod common;
mod hostile;
#[path = "../common/keys.rs"]
mod keys;
mod known;
mod shader;
mod sight;
#[path = "../support/mod.rs"]
mod support;
