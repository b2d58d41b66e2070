from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [
        ("execution", "0004_calls"),
    ]

    operations = [
        migrations.AddIndex(
            model_name="command",
            index=models.Index(
                condition=models.Q(("status__in", ["failed", "rejected", "timed_out"])),
                fields=["ended_at"],
                name="commands_gone_wrong",
            ),
        ),
    ]
