//! The stages between a body and a view.

pub(crate) mod bias;
pub(crate) mod blur;
pub(crate) mod cull;
pub(crate) mod cuts;
pub(crate) mod depth_range;
pub(crate) mod layout;
pub(crate) mod overlap;
pub(crate) mod pixel;
pub(crate) mod served;
pub(crate) mod share;
pub(crate) mod slices;
pub(crate) mod snap;
pub(crate) mod soft;
pub(crate) mod view;
