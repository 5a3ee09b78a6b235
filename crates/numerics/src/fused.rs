//! Multiply-add as one instruction where the target has it.

/// `a · b + c`, with one rounding where the target has the instruction and with two elsewhere: a call into a library that
/// emulates it would cost a hundred times as much.
#[inline(always)]
pub fn multiply_add(a: f64, b: f64, c: f64) -> f64 {
    if cfg!(target_feature = "fma") {
        a.mul_add(b, c)
    } else {
        a * b + c
    }
}
