"""What the paper shows: figures and tables, and what it prints itself.

`plots`, `panels`, `tables`
    `draw` and the style of the figures; a panel for each kind of scene; `typeset` and how numbers
    are spelled.
`mechanics`
    `sketch` of a model, and the springs, dashpots and sliders that it is made of; also of reports.
`quoted`
    `Quoted`, `decimal`: numbers that the text quotes, with their errors.
`printed`
    `printed_values`, `numbered`: what the paper prints, and how it numbers its equations.
"""
