; ARGS: solve OUTPUT
(declare-const a Real)
(declare-const unused Bool)
(assert (= a 1.5))
(check-sat)
(get-value (a unused))
(get-model)
(push)
(declare-const b Int)
(pop)
(declare-const b Real)
(assert (= b 0.5))
(check-sat-assuming ((> a b)))
(get-value (b))
(check-sat-assuming ((< a b)))
(get-value (b))
(reset)
(declare-const a Int)
(assert (and (> a 3) (< a 5)))
(check-sat)
(get-model)
;> sat
;> ((a (/ 3 2))
;>  (unused false))
;> (
;>   (define-fun a () Real (/ 3 2))
;>   (define-fun unused () Bool false)
;> )
;> sat
;> ((b (/ 1 2)))
;> unsat
;> (error "there is no model: the last answer was not `sat`")
;> sat
;> (
;>   (define-fun a () Int 4)
;> )
