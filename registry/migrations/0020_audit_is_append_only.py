"""The database itself refuses to change a line of the record; it may be forgotten as a whole when it is old.

SQLite forgets a table's triggers when Django makes the table anew for a change of its columns: such a migration has to
run `refuse_changes` again.
"""

from django.db import migrations
from django.db.backends.base.schema import BaseDatabaseSchemaEditor

SAID = "A line of the record of what was done cannot be changed."
POSTGRESQL = (
    f"""CREATE FUNCTION registry_auditline_refuse() RETURNS trigger LANGUAGE plpgsql AS
        $$ BEGIN RAISE EXCEPTION '{SAID}'; END $$""",
    """CREATE TRIGGER registry_auditline_append_only BEFORE UPDATE ON registry_auditline
        FOR EACH ROW EXECUTE FUNCTION registry_auditline_refuse()""",
)
SQLITE = (
    f"""CREATE TRIGGER registry_auditline_append_only BEFORE UPDATE ON registry_auditline
        BEGIN SELECT RAISE(ABORT, '{SAID}'); END""",
)


def refuse_changes(_apps: object, editor: BaseDatabaseSchemaEditor) -> None:
    for statement in POSTGRESQL if editor.connection.vendor == "postgresql" else SQLITE:
        editor.execute(statement)


class Migration(migrations.Migration):
    dependencies = [("registry", "0019_people_together")]
    operations = [migrations.RunPython(refuse_changes)]
