; ARGS: solve OUTPUT
; What dReal writes and reads: bounds in declarations, signed numbers, powers, levels.
(set-logic QF_NRA)
(set-option :precision 0.001)
(declare-fun x () Real [-2, 2])
(declare-const y Real [0 1])
(define-fun norm ((a Real) (b Real)) Real (^ (+ (^ a 2) (^ b 2)) (/ 1 2)))
(assert (<= (norm x y) 1))
(push 1)
(echo "too far apart")
(assert (>= x 1.5))
(check-sat)
(pop 1)
(push)
(assert (= (- x y) -0.5))
(assert (= x -0.25))
(check-sat)
(get-model)
(get-value (x (+ x y) (sin y)))
(pop)
(assert (let ((s (sin x)) (c (cos x))) (> (+ (* s s) (* c c)) 1.1)))
(check-sat)
(exit)
(this is never read)
;> too far apart
;> unsat
;> sat
;> (
;>   (define-fun x () Real (- (/ 1 4)))
;>   (define-fun y () Real (/ 1 4))
;> )
;> ((x (- (/ 1 4)))
;>  ((+ x y) 0)
;>  ((sin y) (/ 8913667029669239 36028797018963968)))
;> unsat
