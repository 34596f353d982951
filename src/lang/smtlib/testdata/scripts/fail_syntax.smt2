; ARGS: solve OUTPUT
(declare-fun x () Real)
(assert (let x 1))
;? smt-syntax:9: `let` is written (let ((name term) ...) term)
(assert (>= x 1) (<= x 2))
;? smt-syntax:1: this command is written (assert formula)
)
;? smt-syntax:1: `)` closes nothing
(push -1)
;? smt-syntax:1: this command is written (push n) or (pop n)
(pop)
;? smt-syntax:1: there is no level to pop
(set-option :precision 0)
;? smt-sort:24: the precision is a positive number
(check-sat
;? smt-syntax:1: this list is not closed
;> error: `let` is written (let ((name term) ...) term) [smt-syntax]
;>   --> src/lang/smtlib/testdata/scripts/fail_syntax.smt2:3:9
;>    |
;>  3 | (assert (let x 1))
;>    |         ^^^^^^^^^
;>
;> error: this command is written (assert formula) [smt-syntax]
;>   --> src/lang/smtlib/testdata/scripts/fail_syntax.smt2:5:1
;>    |
;>  5 | (assert (>= x 1) (<= x 2))
;>    | ^^^^^^^^^^^^^^^^^^^^^^^^^^
;>
;> error: `)` closes nothing [smt-syntax]
;>   --> src/lang/smtlib/testdata/scripts/fail_syntax.smt2:7:1
;>    |
;>  7 | )
;>    | ^
;>
;> error: this command is written (push n) or (pop n) [smt-syntax]
;>   --> src/lang/smtlib/testdata/scripts/fail_syntax.smt2:9:1
;>    |
;>  9 | (push -1)
;>    | ^^^^^^^^^
;>
;> error: there is no level to pop [smt-syntax]
;>   --> src/lang/smtlib/testdata/scripts/fail_syntax.smt2:11:1
;>    |
;> 11 | (pop)
;>    | ^^^^^
;>
;> error: the precision is a positive number [smt-sort]
;>   --> src/lang/smtlib/testdata/scripts/fail_syntax.smt2:13:24
;>    |
;> 13 | (set-option :precision 0)
;>    |                        ^
;>
;> error: this list is not closed [smt-syntax]
;>   --> src/lang/smtlib/testdata/scripts/fail_syntax.smt2:15:1
;>    |
;> 15 | (check-sat
;>    | ^ opened here
;> help: add `)` at its end
;>
;> 7 errors
