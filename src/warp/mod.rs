//! How ray coordinates are laid out on a map.

pub(crate) mod uniform;
