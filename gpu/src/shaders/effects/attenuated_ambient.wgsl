// A light's ambient term weakened with distance and by the cone.

//@ at weakened_ambient
ambient * weight
