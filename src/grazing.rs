//! What receivers do where the light grazes them: a stage of the composite.

/// Replaces what maps say of surfaces nearly parallel to the light by a half. There a texel covers more than eleven
/// times its width, lies before and behind the surface at once, and the light that arrives is below 9 % of its
/// strength.
///
/// The angle is that between the light and the normal that the lookup is given; the rule is for all receivers, whether
/// a map holds them or not. It leaves everything as it is where there is nothing to measure: frames without views,
/// which read lit, and receivers without a normal (zero). It is part of `antumbra_visibility` and
/// `antumbra_visibility_noisy` alone: there is no lookup in two stages with it, whose fragments receive no normal.
///
/// After J. Abrantes de Oliveira, *Analysis and proposal of a shadow mapping remix approach*, Universidade do Minho,
/// section 4.2.2.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Grazing {
    /// Maps are asked everywhere.
    #[default]
    Off,
    /// As the thesis has it: ½ from 85° to 90°, and maps are not asked there. The edge shows: visibility leaps by up to
    /// a half at 85°. Surfaces that face away, beyond 90°, are left to the maps.
    Printed,
    /// The same without an edge: from 82° on maps give way to ½, and are not asked from 88° on, nor where surfaces face
    /// away.
    Continuous,
}

impl Grazing {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Off, Self::Printed, Self::Continuous];
}
