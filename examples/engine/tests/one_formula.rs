//! A formula within an ordinary test.

use lightmeter::harness::assert_formula;
use tiny_engine::reflect;

#[test]
fn a_ray_is_reflected() {
    assert_formula("vector/reflect", |x| reflect(x.vec3("i"), x.vec3("n")));
}
