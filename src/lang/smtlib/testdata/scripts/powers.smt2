; ARGS: solve OUTPUT
; x^y by cases: whole exponents of any base, zero to positive powers, positive bases to real powers.
(declare-fun x () Real)
(declare-fun y () Real)
(declare-fun n () Int)
(push 1)
(assert (= n 3))
(assert (= x (^ (- 2) n)))
(check-sat)
(get-value (x))
(pop 1)
(push 1)
(assert (= y 2))
(assert (= (^ 0 y) 0))
(check-sat)
(pop 1)
(push 1)
(assert (= n 0))
(assert (not (= (^ x n) 1)))
(check-sat)
(pop 1)
(push 1)
(assert (and (<= 2 x) (<= x 3) (<= 2 y) (<= y 3)))
(assert (> (^ x y) 27.1))
(check-sat)
(pop 1)
;> sat
;> ((x (- 8)))
;> sat
;> unsat
;> unsat
