// Normals by the inverse transpose of the modelview.

//@ at eye_normal
vector_normal_inverse_transpose(upper, in.normal)
