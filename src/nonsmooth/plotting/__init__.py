"""Pictures of results; the only room that needs matplotlib, which it imports when it draws.

`style`
    Colours, looks and the style sheet that the paper's figures and the manual have, too.
`drawing`
    `drawing.plot` draws whatever a public function returns.
"""
