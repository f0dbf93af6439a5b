// A cone that is brighter in its middle.

//@ at cone
attenuation_spot_exponent(l, axis, cutoff_cosine, scene_spot.lights[i].exponent)
