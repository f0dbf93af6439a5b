use super::*;
use smallvec::smallvec;

/// A graph with two vectors, a number and a matrix.
fn inputs() -> (Graph, [NodeId; 4]) {
    let mut graph = Graph::default();
    let leaves = [
        graph.leaf("a", Type::Float(3), Origin::Input),
        graph.leaf("b", Type::Float(3), Origin::Input),
        graph.leaf("x", Type::Float(1), Origin::Uniform),
        graph.leaf("m", Type::Matrix(3, 3), Origin::Uniform),
    ];
    (graph, leaves)
}

#[test]
fn what_is_the_same_is_one_node() {
    let (mut graph, [a, b, x, m]) = inputs();
    let length = graph.call(Function::Length, smallvec![a]);
    let normal = graph.call(Function::Normalize, smallvec![a]);
    // v/|v|, v·(1/|v|) and v/√(v·v).
    assert_eq!(graph.binary(Binary::Divide, a, length), normal);
    let one = graph.number(1.0);
    let reciprocal = graph.binary(Binary::Divide, one, length);
    assert_eq!(graph.binary(Binary::Multiply, a, reciprocal), normal);
    let square = graph.call(Function::Dot, smallvec![a, a]);
    assert_eq!(graph.call(Function::Sqrt, smallvec![square]), length);
    // x·m is m·x, and a + b is b + a.
    let y = graph.swizzle(b, &[0]);
    for of in [Binary::Multiply, Binary::Add] {
        assert_eq!(graph.binary(of, x, y), graph.binary(of, y, x), "{of:?}");
        assert_eq!(graph.binary(of, a, b), graph.binary(of, b, a), "{of:?}");
    }
    // −a·b, and b·(−a).
    let turned = graph.negate(a);
    let dots = [graph.call(Function::Dot, smallvec![turned, b]), graph.call(Function::Dot, smallvec![b, turned])];
    assert_eq!(dots[0], dots[1]);
    // a − b and −(b − a).
    let difference = graph.binary(Binary::Subtract, b, a);
    let difference = graph.negate(difference);
    assert_eq!(graph.binary(Binary::Subtract, a, b), difference);
    // A vector of its own components, and of components that are computed alike.
    let parts = [0, 1, 2].map(|k| graph.swizzle(a, &[k]));
    assert_eq!(graph.vector(&parts), a);
    let scaled = parts.map(|part| graph.binary(Binary::Multiply, part, x));
    let whole = graph.binary(Binary::Multiply, a, x);
    assert_eq!(graph.vector(&scaled), whole);
    // M·(−a).
    let product = graph.binary(Binary::Multiply, m, a);
    let product = graph.negate(product);
    assert_eq!(graph.binary(Binary::Multiply, m, turned), product);
}

#[test]
fn both_precisions_are_evaluated() {
    let (mut graph, leaves) = inputs();
    let [a, b, x, m] = leaves;
    let moved = graph.binary(Binary::Multiply, m, a);
    let cosine = graph.call(Function::Dot, smallvec![moved, b]);
    let root = graph.call(Function::Pow, smallvec![cosine, x]);
    let given: [&[f64]; 4] =
        [&[1.0, 2.0, 3.0], &[0.5, 0.25, 0.1], &[1.5], &[1.0, 0.0, 0.0, 2.0, 1.0, 0.0, 0.0, 0.0, 1.0]];
    let evaluation = Evaluation::new(&graph, root, &leaves, 100).expect("all leaves are given");
    let wide: Vec<Value<f64>> = given.iter().map(|own| own.iter().copied().collect()).collect();
    // (1 + 4, 2, 3)·(0.5, 0.25, 0.1) = 3.3
    let expected = 3.3_f64.powf(1.5);
    assert!((evaluation.value(&wide, &mut vec![]).first() - expected).abs() < 1e-12);
    #[expect(clippy::cast_possible_truncation, reason = "that is what is tried")]
    let narrow: Vec<Value<f32>> = given.iter().map(|own| own.iter().map(|own| *own as f32).collect()).collect();
    let found = f64::from(evaluation.value(&narrow, &mut vec![]).first());
    assert!((found - expected).abs() < 1e-5 && found.to_bits() != expected.to_bits(), "{found} for {expected}");
    // A leaf that is not given, and more operations than are allowed.
    assert!(Evaluation::new(&graph, root, &[a, b], 100).is_none());
    assert!(Evaluation::new(&graph, root, &leaves, 2).is_none());
}
