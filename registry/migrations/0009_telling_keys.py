from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [("registry", "0008_legacy_topics")]

    operations = [migrations.AddField("device", "key_told_at", models.DateTimeField(null=True))]
