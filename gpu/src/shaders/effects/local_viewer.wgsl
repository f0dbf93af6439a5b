// v = ⟨−p⟩.

//@ at viewer
//@ when vectors_interpolated
vector_normalize(in.viewer)
//@ end
//@ when !vectors_interpolated
vector_normalize(-p)
//@ end
