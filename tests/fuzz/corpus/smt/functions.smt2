(declare-const x Real)(declare-const y Real)(declare-const b Bool)
(assert (or b (< (atan2 y x) (tan y)) (= (asin x) (acos y)) (>= (log x) (sqrt (- y)))))
(assert (xor b (distinct x y (min x y (max x y)))))
(check-sat)
