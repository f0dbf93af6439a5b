// v = ⟨−p⟩.

//@ at viewer
vector_normalize(-p)
