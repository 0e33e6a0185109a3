//! The attitude that Hairer and Vilmart publish for their rigid body.

/// The momentum at the beginning.
pub const Y0: [f64; 3] = [1.8, 0.4, -0.9];
/// q(10), published, and checked by an independent integration.
pub const Q10: [f64; 4] = [
    -0.736_061_364_160_793_9,
    -0.570_786_951_240_350_7,
    -0.299_388_571_830_790_1,
    -0.206_839_086_104_673_2,
];
