from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [
        ("execution", "0011_permits"),
    ]

    operations = [
        migrations.AddField(
            model_name="rehearsal",
            name="asked",
            field=models.JSONField(db_default={}, default=dict),
        ),
    ]
