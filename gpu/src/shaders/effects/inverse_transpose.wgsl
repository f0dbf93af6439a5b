// Normals by the inverse transpose of the modelview, in its stable form: without the division by the determinant.

//@ at eye_normal
vector_normal_by_cofactors(upper, in.normal)
