import django.db.models.deletion
from django.conf import settings
from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [("registry", "0007_robot_maps")]

    operations = [
        migrations.AddField("device", "granted", models.JSONField(default=dict)),
        migrations.CreateModel(
            name="TopicClaim",
            fields=[
                ("topic", models.CharField(max_length=200, primary_key=True, serialize=False)),
                ("method", models.CharField(max_length=64)),
                ("asked_at", models.DateTimeField()),
                ("confirmed_at", models.DateTimeField(null=True)),
                (
                    "confirmed_by",
                    models.ForeignKey(
                        null=True,
                        on_delete=django.db.models.deletion.SET_NULL,
                        related_name="+",
                        to=settings.AUTH_USER_MODEL,
                    ),
                ),
                (
                    "device",
                    models.ForeignKey(
                        on_delete=django.db.models.deletion.CASCADE, related_name="claims", to="registry.device"
                    ),
                ),
            ],
            options={
                "constraints": [models.UniqueConstraint(fields=("device", "method"), name="one_topic_per_method")]
            },
        ),
    ]
