from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [("registry", "0013_keyed_requests")]

    operations = [
        migrations.AddField("site", "join_key_sealed", models.CharField(blank=True, max_length=500)),
        migrations.AddField("site", "join_key_at", models.DateTimeField(null=True)),
    ]
