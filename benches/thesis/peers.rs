//! What two engines score on the shared cases.

/// A case at a size of map: root mean square errors against the area truth.
pub(crate) struct Peer {
    pub(crate) case: &'static str,
    pub(crate) size: u32,
    /// Of a perfect hard-edged mask.
    pub(crate) floor: f64,
    pub(crate) bevy: f64,
    pub(crate) three: f64,
}

impl Peer {
    /// The better engine's.
    pub(crate) fn better(&self) -> f64 {
        self.bevy.min(self.three)
    }
}

/// Case, floor, and for maps of 512, 1024 and 2048 texels: Bevy 0.19.1 (4 cascades, Gaussian filter, default bias) and
/// three.js 0.187 (CSM addon, 4 cascades, practical splits, fade, PCF; distance and biases tuned on these cases),
/// 800×600. Measured once, with an independent ray tracer and these metrics.
const SCORES: [(&str, f64, [[f64; 2]; 3]); 9] = [
    ("columns-row", 0.0526, [[0.0752, 0.0703], [0.0459, 0.0524], [0.0355, 0.0440]]),
    ("fence-general", 0.0833, [[0.1113, 0.0910], [0.0821, 0.0595], [0.0594, 0.0553]]),
    ("fence-stack", 0.0580, [[0.0860, 0.0647], [0.0624, 0.0496], [0.0467, 0.0404]]),
    ("fence-wide", 0.0625, [[0.2192, 0.1576], [0.1853, 0.0991], [0.1285, 0.0651]]),
    ("sparsecity-entity", 0.0273, [[0.0691, 0.0488], [0.0579, 0.0434], [0.0492, 0.0389]]),
    ("sparsecity-overview", 0.0593, [[0.1725, 0.1122], [0.1219, 0.0728], [0.0834, 0.0533]]),
    ("treeline-dueling", 0.0655, [[0.1764, 0.1322], [0.1430, 0.0999], [0.1113, 0.0718]]),
    ("treeline-ground", 0.1107, [[0.1632, 0.1393], [0.1367, 0.1118], [0.1169, 0.0941]]),
    ("treeline-trunk", 0.0961, [[0.2149, 0.1233], [0.1692, 0.0811], [0.1284, 0.0590]]),
];

/// Sides of maps, texels.
const SIZES: [u32; 3] = [512, 1024, 2048];

/// The engines on a case at a size, if they were measured there.
pub(crate) fn peer(case: &str, size: u32) -> Option<Peer> {
    let (case, floor, scores) = SCORES.iter().find(|(name, ..)| *name == case)?;
    let at = SIZES.iter().position(|known| *known == size)?;
    let [bevy, three] = scores[at];
    Some(Peer { case, size, floor: *floor, bevy, three })
}
