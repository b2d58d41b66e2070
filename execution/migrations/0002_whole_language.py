import uuid

import django.db.models.deletion
from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [
        ("execution", "0001_initial"),
        ("registry", "0001_initial"),
    ]

    operations = [
        migrations.AddField(
            model_name="run",
            name="entry",
            field=models.PositiveIntegerField(default=0),
        ),
        migrations.AddField(
            model_name="run",
            name="notices",
            field=models.JSONField(default=dict),
        ),
        migrations.CreateModel(
            name="ArmedProgram",
            fields=[
                ("program", models.UUIDField(primary_key=True, serialize=False)),
                ("prepared", models.JSONField(default=dict)),
                ("truths", models.JSONField(default=dict)),
                ("epoch", models.PositiveIntegerField(default=0)),
                ("by", models.CharField(max_length=120)),
                ("at", models.DateTimeField()),
                (
                    "site",
                    models.ForeignKey(
                        on_delete=django.db.models.deletion.CASCADE, related_name="armed_programs", to="registry.site"
                    ),
                ),
            ],
        ),
        migrations.CreateModel(
            name="Question",
            fields=[
                ("id", models.UUIDField(default=uuid.uuid4, primary_key=True, serialize=False)),
                ("number", models.PositiveIntegerField()),
                ("step", models.CharField(blank=True, max_length=64)),
                ("text", models.CharField(max_length=500)),
                ("answer", models.JSONField(default=dict)),
                (
                    "state",
                    models.CharField(
                        choices=[("open", "Open"), ("answered", "Answered"), ("withdrawn", "Withdrawn")],
                        default="open",
                        max_length=10,
                    ),
                ),
                ("value", models.JSONField(null=True)),
                ("asked_at", models.DateTimeField()),
                ("answered_by", models.CharField(blank=True, max_length=120)),
                ("answered_at", models.DateTimeField(null=True)),
                (
                    "run",
                    models.ForeignKey(
                        on_delete=django.db.models.deletion.CASCADE, related_name="questions", to="execution.run"
                    ),
                ),
            ],
            options={
                "indexes": [models.Index(fields=["state"], name="execution_q_state_8fa3d4_idx")],
                "constraints": [models.UniqueConstraint(fields=("run", "number"), name="one_question_per_number")],
            },
        ),
    ]
