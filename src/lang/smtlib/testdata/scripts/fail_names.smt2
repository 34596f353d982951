; ARGS: solve OUTPUT
(declare-fun speed () Real)
(declare-fun speed () Real)
;? smt-undeclared:14: `speed` is declared twice
(define-fun twice ((a Real)) Real (* 2 a))
(assert (>= sped 1))
;? smt-undeclared:13: `sped` is not declared
(assert (>= (twise speed) 1))
;? smt-unsupported:14: `twise` is no operator
(assert (>= (twice speed speed) 1))
;? smt-sort:13: `twice` takes 1 argument, not 2
(check-sat)
;> error: `speed` is declared twice [smt-undeclared]
;>   --> src/lang/smtlib/testdata/scripts/fail_names.smt2:3:14
;>    |
;>  3 | (declare-fun speed () Real)
;>    |              ^^^^^
;>
;> error: `sped` is not declared [smt-undeclared]
;>   --> src/lang/smtlib/testdata/scripts/fail_names.smt2:6:13
;>    |
;>  6 | (assert (>= sped 1))
;>    |             ^^^^
;> help: did you mean `speed`?
;>    |
;>  6 | (assert (>= speed 1))
;>    |             ~~~~~
;>
;> error: `twise` is no operator [smt-unsupported]
;>   --> src/lang/smtlib/testdata/scripts/fail_names.smt2:8:14
;>    |
;>  8 | (assert (>= (twise speed) 1))
;>    |              ^^^^^
;> help: did you mean `twice`?
;>    |
;>  8 | (assert (>= (twice speed) 1))
;>    |              ~~~~~
;>
;> error: `twice` takes 1 argument, not 2 [smt-sort]
;>   --> src/lang/smtlib/testdata/scripts/fail_names.smt2:10:13
;>    |
;> 10 | (assert (>= (twice speed speed) 1))
;>    |             ^^^^^^^^^^^^^^^^^^^
;>
;> 4 errors
