(declare-fun x () Real [-1e300, 1e300])
(declare-fun i () Int)
(assert (= (* x x x) (/ 1 3)))(assert (> (^ x -2) (/ x 0)))(assert (< i 5))(assert (= (to_real i) (exp (* 700 x))))
(check-sat)
