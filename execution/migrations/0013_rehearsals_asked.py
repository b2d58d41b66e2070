from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [
        ("execution", "0012_program_tests"),
    ]

    operations = [
        migrations.AddField(
            model_name="rehearsal",
            name="asked",
            field=models.JSONField(db_default={}, default=dict),
        ),
    ]
