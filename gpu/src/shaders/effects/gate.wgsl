// No highlight on a face that is turned away.

//@ at gated
lighting_gate(n, l, highlight)
