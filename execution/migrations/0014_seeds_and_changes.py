from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [
        ("execution", "0013_rehearsals_asked"),
    ]

    operations = [
        migrations.AddField(
            model_name="trialrun",
            name="seeds",
            field=models.PositiveSmallIntegerField(db_default=0, default=0),
        ),
        migrations.AddField(
            model_name="trialrun",
            name="tries_changes",
            field=models.BooleanField(db_default=False, default=False),
        ),
        migrations.AddField(
            model_name="trialrun",
            name="changes",
            field=models.JSONField(null=True),
        ),
        migrations.AddField(
            model_name="trialrun",
            name="site",
            field=models.JSONField(db_default={}, default=dict),
        ),
    ]
