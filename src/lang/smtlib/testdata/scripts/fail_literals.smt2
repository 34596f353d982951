; ARGS: solve
(declare-const a Real)
(assert (> a 1e1000))
;? smt-unsupported:14: `1e1000` is no number that can be read
(assert (> a 0x1p3))
;? smt-unsupported:14: `0x1p3` is no number that can be read
(assert (> a #x1F))
;? smt-unsupported:14: `#x1F` is no number that can be read
