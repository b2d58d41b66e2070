from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [
        ("execution", "0020_places_of_runs"),
    ]

    operations = [
        migrations.AddIndex(
            model_name="command",
            index=models.Index(
                condition=models.Q(("status", "done")),
                fields=["device", "method", "ended_at"],
                name="commands_done",
            ),
        ),
    ]
