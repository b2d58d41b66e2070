from django.db import migrations, models


class Migration(migrations.Migration):
    dependencies = [("registry", "0014_join_key_shown")]

    operations = [
        migrations.AddField("apitoken", "broker_hash", models.CharField(blank=True, max_length=160)),
    ]
