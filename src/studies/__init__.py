"""Studies: tables of scenes and questions, from one file to a report.

The workflow's rules in `workflow/rules/studies.smk` call this package. A file is read and every
scene and question of it is checked before anything runs; every answer is an artifact of its own.

`study`
    `Study`: the file, its scenes by name, its questions, and which scenes share a job.
`checks`
    `require_sound`: what cannot be asked is refused in one line with its key and the cure.
`units`
    `Units`: quantities such as "2 mm" as numbers of a scene, and a scene's numbers in the user's
    units.
`scenes`
    `scene_of`: the scene of a row of the table, given dimensionless or in SI units.
`questions`
    `QUESTIONS`: what can be asked, one entry each.
`answers`
    `answer`, `answer_batch`: answers as datasets in the user's units.
`equations`, `drawing`, `figures`
    What a report shows of a scene and of an answer.
`surveys`
    Maps of what a sweep has found.
`report`
    The report as HTML and PDF.
"""
